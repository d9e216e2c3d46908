// A stack machine that runs one instruction after the other from a buffer, for any formula of its
// operations. Values are four lanes wide; a number is the same in all of them, a vector's unused
// lanes hold anything.
//
// The topmost value is kept apart from the stack; an instruction may have its second operand in
// itself or in a local, and its operands swapped; stack and locals are one array, which an
// instruction reads and writes once. Such an array is memory, and costs more than arithmetic.

// Push the point, or the second operand.
const POINT: u32 = 0;
const PUSH: u32 = 1;
// Unary operations on the topmost value. SQRT, SIN and COS take numbers. STORE copies the value to
// the local.
const LANE: u32 = 2;
const ABS: u32 = 3;
const FLOOR: u32 = 4;
const SQRT: u32 = 5;
const SIN: u32 = 6;
const COS: u32 = 7;
const LENGTH: u32 = 8;
const STORE: u32 = 9;
// Pops the topmost value and keeps whether it is not 0, for the next CHOOSE.
const TEST: u32 = 10;
// Binary operations on two operands a and b.
const ADD: u32 = 11;
const SUB: u32 = 12;
const MUL: u32 = 13;
const DIV: u32 = 14;
const MIN: u32 = 15;
const MAX: u32 = 16;
const DOT: u32 = 17;
const LESS: u32 = 18;
const INSERT: u32 = 19;
const CHOOSE: u32 = 20;

// Where the second operand is: on top of the stack, in the instruction, or in the first or a later
// local.
const ON_STACK: u32 = 0;
const CONSTANT: u32 = 1;
const LOCAL: u32 = 2;

// The encoder keeps within both. The topmost value of a full stack is elsewhere, and one entry is
// spare.
const STACK_SIZE: u32 = 16;
const LOCAL_COUNT: u32 = 16;

const LANES = vec4u(0, 1, 2, 3);

struct Instruction {
    operation: u32,
    // Index of a lane (LANE, INSERT), or number of lanes (LENGTH, DOT).
    index: u32,
    second: u32,
    // 1 if the second operand is a and the first is b.
    reversed: u32,
    constant: vec4f,
}

@group(0) @binding(3) var<storage, read> tape: array<Instruction>;

// The stack, then the locals. Private, so that they are cleared once per invocation and not for
// each evaluation.
var<private> memory: array<vec4f, STACK_SIZE + 1 + LOCAL_COUNT>;

fn first_lanes(value: vec4f, count: u32) -> vec4f {
    return select(vec4f(), value, LANES < vec4u(count));
}

fn field(p: vec3f) -> f32 {
    // The number of values below the topmost.
    var depth = 0u;
    var top = vec4f();
    var chosen = false;
    for (var i = 0u; i < arrayLength(&tape); i++) {
        let instruction = tape[i];
        let operation = instruction.operation;
        let second = instruction.second;
        let local = STACK_SIZE + 1u + second - LOCAL;
        // Harmless if nothing is pushed or stored: there is nothing above the stack.
        memory[select(depth, local, operation == STORE)] = top;
        let found = memory[select(max(depth, 1u) - 1u, local, second >= LOCAL)];
        var a = top;
        var b = select(found, instruction.constant, second == CONSTANT);
        if operation <= PUSH {
            depth++;
        } else if operation >= TEST && second == ON_STACK {
            depth--;
            a = found;
            b = top;
        }
        if instruction.reversed != 0u {
            let first = a;
            a = b;
            b = first;
        }
        switch operation {
            case POINT: {
                top = vec4f(p, 0.0);
            }
            case PUSH: {
                top = b;
            }
            case LANE: {
                top = vec4f(a[instruction.index]);
            }
            case ABS: {
                top = abs(a);
            }
            case FLOOR: {
                top = floor(a);
            }
            case SQRT: {
                top = vec4f(sqrt(a.x));
            }
            case SIN: {
                top = vec4f(sin(a.x));
            }
            case COS: {
                top = vec4f(cos(a.x));
            }
            case LENGTH: {
                top = vec4f(length(first_lanes(a, instruction.index)));
            }
            case TEST: {
                chosen = top.x != 0.0;
                top = a;
            }
            case ADD: {
                top = a + b;
            }
            case SUB: {
                top = a - b;
            }
            case MUL: {
                top = a * b;
            }
            case DIV: {
                top = a / b;
            }
            case MIN: {
                top = min(a, b);
            }
            case MAX: {
                top = max(a, b);
            }
            case DOT: {
                let count = instruction.index;
                top = vec4f(dot(first_lanes(a, count), first_lanes(b, count)));
            }
            case LESS: {
                top = select(vec4f(), vec4f(1.0), a < b);
            }
            case INSERT: {
                top = select(a, b, LANES == vec4u(instruction.index));
            }
            case CHOOSE: {
                top = select(b, a, chosen);
            }
            default: {
            }
        }
    }
    return top.x;
}

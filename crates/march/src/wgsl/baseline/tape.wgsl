// A stack machine: one instruction after the other from a buffer, for any formula of its operations. Values
// are four lanes wide; a number is the same in all of them, a vector's unused lanes hold anything.
// The topmost value is kept apart from the stack, a binary operation may have its second operand in the
// instruction, and stack and locals are one array, so that an instruction reads and writes it once: such an array
// is memory, and costs more than arithmetic.

// Push a value: the point, the instruction's constant, a local.
const POINT: u32 = 0;
const CONSTANT: u32 = 1;
const LOAD: u32 = 2;
// From the topmost value. SQRT, SIN and COS are of numbers. STORE and TEST take it off the stack; TEST keeps
// whether it is not 0, for the next CHOOSE.
const LANE: u32 = 3;
const ABS: u32 = 4;
const FLOOR: u32 = 5;
const SQRT: u32 = 6;
const SIN: u32 = 7;
const COS: u32 = 8;
const LENGTH: u32 = 9;
const STORE: u32 = 10;
const TEST: u32 = 11;
// From the topmost value b and the one below it, a.
const ADD: u32 = 12;
const SUB: u32 = 13;
const MUL: u32 = 14;
const DIV: u32 = 15;
const MIN: u32 = 16;
const MAX: u32 = 17;
const DOT: u32 = 18;
const LESS: u32 = 19;
const INSERT: u32 = 20;
const CHOOSE: u32 = 21;

// The encoder keeps within both. A stack that is full has its topmost value elsewhere, and one place to spare.
const STACK_SIZE: u32 = 16;
const LOCAL_COUNT: u32 = 16;

const LANES = vec4u(0, 1, 2, 3);

struct Instruction {
    operation: u32,
    // Index of a local (LOAD, STORE) or of a lane (LANE, INSERT), or the number of lanes (LENGTH, DOT).
    index: u32,
    // 1 where the second operand is the constant; of STORE, where the value also stays on the stack.
    immediate: u32,
    pad: u32,
    constant: vec4f,
}

@group(0) @binding(3) var<storage, read> tape: array<Instruction>;

// The stack, then the locals. Private, so that it is cleared once for each invocation and not at each evaluation.
var<private> memory: array<vec4f, STACK_SIZE + 1 + LOCAL_COUNT>;

fn first_lanes(value: vec4f, count: u32) -> vec4f {
    return select(vec4f(), value, LANES < vec4u(count));
}

fn field(p: vec3f) -> f32 {
    // How many values lie below the topmost.
    var depth = 0u;
    var top = vec4f();
    var chosen = false;
    for (var i = 0u; i < arrayLength(&tape); i++) {
        let instruction = tape[i];
        let operation = instruction.operation;
        let local = STACK_SIZE + 1u + instruction.index;
        // Harmless where nothing is pushed or stored: there is nothing above the stack.
        memory[select(depth, local, operation == STORE)] = top;
        let below = memory[select(max(depth, 1u) - 1u, local, operation == LOAD)];
        var a = top;
        var b = instruction.constant;
        if operation <= LOAD {
            depth++;
        } else if operation >= STORE && instruction.immediate == 0u {
            depth--;
            a = below;
            b = top;
        }
        switch operation {
            case POINT: {
                top = vec4f(p, 0.0);
            }
            case CONSTANT: {
                top = b;
            }
            case LOAD: {
                top = below;
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
            case STORE: {
                top = a;
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

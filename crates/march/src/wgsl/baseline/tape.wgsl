// A stack machine: one instruction after the other from a buffer, for any formula of its operations. Values
// are four lanes wide; a number is the same in all of them, a vector's unused lanes hold anything.
// The topmost value is kept apart from the stack, and a binary operation may have its second operand in the
// instruction: both spare traffic with the stack.

// Push a value: the point, the instruction's constant, a local.
const POINT: u32 = 0;
const CONSTANT: u32 = 1;
const LOAD: u32 = 2;
// From the topmost value.
const STORE: u32 = 3;
const LANE: u32 = 4;
const ABS: u32 = 5;
const FLOOR: u32 = 6;
const SQRT: u32 = 7;
const SIN: u32 = 8;
const COS: u32 = 9;
const LENGTH: u32 = 10;
// From the topmost value b and the one below it, a.
const ADD: u32 = 11;
const SUB: u32 = 12;
const MUL: u32 = 13;
const DIV: u32 = 14;
const MIN: u32 = 15;
const MAX: u32 = 16;
const DOT: u32 = 17;
const LESS: u32 = 18;
const INSERT: u32 = 19;
// From three values: what to take where the lowest is not 0, and where it is.
const SELECT: u32 = 20;

// The encoder keeps within both.
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

// Private, so that they are cleared once for each invocation and not at each evaluation.
var<private> stack: array<vec4f, STACK_SIZE>;
var<private> locals: array<vec4f, LOCAL_COUNT>;

fn first_lanes(value: vec4f, count: u32) -> vec4f {
    return select(vec4f(), value, LANES < vec4u(count));
}

fn field(p: vec3f) -> f32 {
    // How many values lie below the topmost.
    var depth = 0u;
    var top = vec4f();
    for (var i = 0u; i < arrayLength(&tape); i++) {
        let instruction = tape[i];
        let operation = instruction.operation;
        var a = top;
        var b = instruction.constant;
        if operation <= LOAD {
            stack[depth] = top;
            depth++;
        } else if operation >= ADD && instruction.immediate == 0u {
            depth--;
            a = stack[depth];
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
                top = locals[instruction.index];
            }
            case STORE: {
                locals[instruction.index] = a;
                if instruction.immediate == 0u {
                    depth--;
                    top = stack[depth];
                }
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
                top = sqrt(a);
            }
            case SIN: {
                top = sin(a);
            }
            case COS: {
                top = cos(a);
            }
            case LENGTH: {
                top = vec4f(length(first_lanes(a, instruction.index)));
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
            case SELECT: {
                depth--;
                top = select(b, a, stack[depth] != vec4f());
            }
            default: {
            }
        }
    }
    return top.x;
}

/**
 * @file The grammar of sdfc scenes. `docs/language/reference.md` has the same rules as EBNF.
 * @license MIT OR Apache-2.0
 */

/// <reference types="tree-sitter-cli/dsl" />
// @ts-check

/** Elements between commas, with an optional comma behind the last. */
const commaSeparated = (rule) => optional(seq(rule, repeat(seq(',', rule)), optional(',')));

/** Operands joined by operators that associate to the left. */
const infix = (left, operators, right) =>
  seq(
    field('left', left),
    field('operator', typeof operators === 'string' ? operators : choice(...operators)),
    field('right', right),
  );

module.exports = grammar({
  name: 'sdf',

  word: ($) => $.identifier,

  // What depends on the rest of the line, and literals that no word may follow without a space.
  externals: ($) => [
    $._end_of_line,
    $._call_open,
    $._index_open,
    $._lambda_end,
    $.number,
    $.color,
    $._error_sentinel,
  ],

  extras: ($) => [/[ \t\r\n\f]/, $.doc_comment, $.comment],

  reserved: {
    global: () => [
      'let', 'param', 'fn', 'solid', 'region', 'shape', 'import', 'if', 'else', 'for', 'in',
      'true', 'false',
    ],
  },

  supertypes: ($) => [$.expression, $.type, $.item],


  rules: {
    source_file: ($) => repeat(seq($.item, $._end)),

    // The next token begins a line and does not continue the expression; or the file ends.
    _end: ($) => choice(';', $._end_of_line),

    item: ($) => choice($.import, $.param, $.declaration, $.let, $.expression),

    // ---- Items

    import: ($) =>
      seq(
        'import',
        $.imported_name,
        repeat(seq(',', $.imported_name)),
        'from',
        field('path', $.string),
      ),

    imported_name: ($) =>
      seq(field('name', $.identifier), optional(seq('as', field('alias', $.identifier)))),

    param: ($) =>
      seq(
        'param',
        field('name', $.identifier),
        optional(seq(':', field('type', $.type))),
        '=',
        field('default', $.expression),
        optional(seq('in', field('range', $.expression))),
      ),

    let: ($) =>
      seq('let', field('name', $.identifier), '=', field('value', $.expression)),

    declaration: ($) =>
      choice(
        seq(
          field('kind', 'fn'),
          field('name', $.identifier),
          $._fn_signature,
          '=',
          field('body', $.expression),
        ),
        seq(
          field('kind', choice('solid', 'region', 'shape')),
          field('name', $.identifier),
          $._shape_signature,
          '=',
          field('body', $.expression),
        ),
      ),

    _fn_signature: ($) =>
      seq($._parameters_and_result, repeat(choice($.lipschitz_clause, $.require_clause))),

    _shape_signature: ($) => seq($._parameters_and_result, repeat($._clause)),

    _parameters_and_result: ($) =>
      seq(
        field('parameters', $.parameters),
        optional(seq('->', field('result', $.type))),
      ),

    parameters: ($) => seq('(', commaSeparated($.parameter), ')'),

    parameter: ($) =>
      seq(
        field('name', $.identifier),
        optional(seq(':', field('type', $.type), optional('...'))),
        optional(seq('=', field('default', $.expression))),
        optional(seq('in', field('range', $.expression))),
      ),

    _clause: ($) =>
      choice(
        $.promise_clause,
        $.lipschitz_clause,
        $.bounds_clause,
        $.material_clause,
        $.intersect_clause,
        $.copies_clause,
        $.require_clause,
      ),

    promise_clause: ($) =>
      seq(
        choice('exact', 'bound'),
        optional(field('side', choice('outside', 'inside'))),
        optional(seq('if', field('condition', $.expression))),
      ),

    lipschitz_clause: ($) =>
      seq('lipschitz', field('constant', $.expression), optional('everywhere')),

    bounds_clause: ($) => seq('bounds', $.expression),
    material_clause: ($) => seq('material', $.expression),
    intersect_clause: ($) => seq('intersect', $.expression),
    copies_clause: () => 'copies',

    require_clause: ($) =>
      seq('require', field('condition', $.expression), ',', field('message', $.string)),

    // ---- Types

    type: ($) => choice($.type_name, $.list_type, $.record_type, $.function_type),

    type_name: ($) => choice($.identifier, 'solid', 'region', 'shape'),

    list_type: ($) => seq('[', $.type, ']'),

    record_type: ($) => seq('(', $.field_type, repeat(seq(',', $.field_type)), optional(','), ')'),

    field_type: ($) => seq(field('name', $.identifier), ':', field('type', $.type)),

    function_type: ($) =>
      seq(
        'fn',
        '(',
        commaSeparated(field('parameter', $.type)),
        ')',
        '->',
        field('result', $.type),
      ),

    // ---- Expressions, from the loosest operators to the tightest

    expression: ($) => $._or,

    _or: ($) => choice(alias($._or_chain, $.binary_expression), $._and),
    _or_chain: ($) => infix($._or, '||', $._and),

    _and: ($) => choice(alias($._and_chain, $.binary_expression), $._comparison),
    _and_chain: ($) => infix($._and, '&&', $._comparison),

    // Comparisons and ranges do not chain.
    _comparison: ($) => choice(alias($._one_comparison, $.binary_expression), $._span),
    _one_comparison: ($) => infix($._span, ['==', '!=', '<', '<=', '>', '>='], $._span),

    _span: ($) => choice($.range, $._sum),
    range: ($) =>
      seq(field('from', $._sum), '..', field('to', $._sum)),

    // `a | b & c` is an error: most languages bind `&` tighter.
    _sum: ($) => choice(alias($._union, $.binary_expression), $._other_sum),
    _other_sum: ($) =>
      choice(
        alias($._difference, $.binary_expression),
        alias($._intersection, $.binary_expression),
        $._product,
      ),
    _union: ($) => infix($._sum, '|', $._product),
    _difference: ($) => infix($._sum, ['+', '-'], $._product),
    _intersection: ($) => infix($._other_sum, '&', $._product),

    _product: ($) => choice(alias($._product_chain, $.binary_expression), $._prefix),
    _product_chain: ($) => infix($._product, ['*', '/', '%'], $._prefix),

    _prefix: ($) => choice($.unary_expression, $._postfix),
    unary_expression: ($) =>
      seq(field('operator', choice('-', '!')), field('operand', $._prefix)),

    _postfix: ($) =>
      choice($.call_expression, $.field_expression, $.index_expression, $._primary),

    call_expression: ($) =>
      seq(field('function', $._postfix), field('arguments', $.arguments)),

    arguments: ($) =>
      seq(
        alias($._call_open, '('),
        commaSeparated(choice($.named_argument, $._element)),
        ')',
      ),

    named_argument: ($) =>
      seq(field('name', $.identifier), ':', field('value', $.expression)),

    field_expression: ($) =>
      seq(field('value', $._postfix), '.', field('name', $.identifier)),

    index_expression: ($) =>
      seq(
        field('value', $._postfix),
        alias($._index_open, '['),
        field('index', $.expression),
        ']',
      ),

    _primary: ($) =>
      choice(
        $.number,
        $.color,
        $.string,
        $.boolean,
        $.identifier,
        $.parenthesized_expression,
        $.record,
        $.list,
        $.block,
        $.if_expression,
        $.lambda,
      ),

    parenthesized_expression: ($) => seq('(', $.expression, ')'),

    record: ($) => seq('(', $.field, repeat(seq(',', $.field)), optional(','), ')'),

    field: ($) => seq(field('name', $.identifier), ':', field('value', $.expression)),

    list: ($) => seq('[', commaSeparated($._element), ']'),

    _element: ($) => choice($.expression, $.comprehension),

    comprehension: ($) =>
      seq(
        'for',
        field('name', $.identifier),
        'in',
        field('over', $.expression),
        optional(seq('if', field('condition', $.expression))),
        ':',
        field('element', $._element),
      ),

    block: ($) =>
      seq('{', repeat(seq($.let, $._end)), field('value', $.expression), optional($._end), '}'),

    if_expression: ($) =>
      seq(
        'if',
        field('condition', $.expression),
        field('then', $.block),
        'else',
        field('else', choice($.if_expression, $.block)),
      ),

    // The body reaches as far as it can: no operator follows it.
    lambda: ($) => seq('fn', $._fn_signature, '=', field('body', $.expression), $._lambda_end),

    // ---- Tokens

    identifier: () => /[A-Za-z_][A-Za-z0-9_]*/,

    boolean: () => choice('true', 'false'),

    string: ($) =>
      seq(
        '"',
        repeat(choice($.string_content, $.escape_sequence)),
        token.immediate('"'),
      ),

    string_content: () => token.immediate(prec(1, /[^"\\\n]+/)),

    escape_sequence: () =>
      token.immediate(
        prec(
          1,
          choice(
            /\\["\\n]/,
            // A Unicode scalar value: no surrogates, at most 10ffff.
            /\\u\{0*[0-9a-fA-F]{1,3}\}/,
            /\\u\{0*[1-9abcefABCEF][0-9a-fA-F]{3}\}/,
            /\\u\{0*[dD][0-7][0-9a-fA-F]{2}\}/,
            /\\u\{0*[1-9a-fA-F][0-9a-fA-F]{4}\}/,
            /\\u\{0*10[0-9a-fA-F]{4}\}/,
          ),
        ),
      ),

    // Three slashes, not four. It stands before `comment`, so that it wins where both match.
    doc_comment: () => token(/\/\/\/([^\r\n\/]([^\r\n]|\r[^\r\n])*)?/),

    comment: () => token(/\/\/([^\r\n]|\r[^\r\n])*/),
  },
});

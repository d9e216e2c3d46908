; Roles of words, in the scopes of Helix. A later pattern wins over an earlier one.

(comment) @comment.line
(doc_comment) @comment.line.documentation

(identifier) @variable
((identifier) @variable.builtin (#eq? @variable.builtin "p"))
((identifier) @constant.builtin (#any-of? @constant.builtin "pi" "tau" "inf"))

(field_expression name: (identifier) @variable.other.member)
(call_expression function: (identifier) @function)
(call_expression
  function: (field_expression name: (identifier) @function.method))

(declaration name: (identifier) @function)
(param name: (identifier) @variable.parameter)
(parameter name: (identifier) @variable.parameter)
(named_argument name: (identifier) @variable.parameter)
(field name: (identifier) @variable.other.member)
(field_type name: (identifier) @variable.other.member)
(imported_name (identifier) @function)

(type_name) @type
(type_name (identifier) @type)
(type_name ["solid" "region" "shape"] @type)

(number) @constant.numeric
(color) @constant
(boolean) @constant.builtin.boolean
(string) @string
(escape_sequence) @constant.character.escape

["let" "param"] @keyword.storage
["import" "from" "as"] @keyword.control.import
["if" "else"] @keyword.control.conditional
["for" "in"] @keyword.control.repeat
(declaration kind: _ @keyword.function)
(lambda "fn" @keyword.function)
(function_type "fn" @keyword.function)
(promise_clause ["exact" "bound" "outside" "inside"] @keyword.directive)
(lipschitz_clause ["lipschitz" "everywhere"] @keyword.directive)
(bounds_clause "bounds" @keyword.directive)
(material_clause "material" @keyword.directive)
(intersect_clause "intersect" @keyword.directive)
(copies_clause) @keyword.directive
(require_clause "require" @keyword.directive)

[
  "||" "&&" "==" "!=" "<" "<=" ">" ">=" ".." "+" "-" "|" "&" "*" "/" "%" "!" "=" "->" "..."
] @operator

["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," ":" ";" "."] @punctuation.delimiter

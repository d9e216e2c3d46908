; Roles of words. A later pattern wins over an earlier one.

(comment) @comment
(doc_comment) @comment.documentation

(identifier) @variable
((identifier) @variable.builtin (#eq? @variable.builtin "p"))
((identifier) @constant.builtin (#any-of? @constant.builtin "pi" "tau" "inf"))

(field_expression name: (identifier) @property)
(call_expression function: (identifier) @function.call)
(call_expression
  function: (field_expression name: (identifier) @function.method.call))

(declaration name: (identifier) @function)
(param name: (identifier) @variable.parameter)
(parameter name: (identifier) @variable.parameter)
(named_argument name: (identifier) @variable.parameter)
(field name: (identifier) @property)
(field_type name: (identifier) @property)
(imported_name (identifier) @function)

(type_name) @type
(type_name (identifier) @type)
(type_name ["solid" "region" "shape"] @type)

(number) @number
(color) @constant
(boolean) @boolean
(string) @string
(escape_sequence) @string.escape

["let" "param"] @keyword
["import" "from" "as"] @keyword.import
["if" "else"] @keyword.conditional
["for" "in"] @keyword.repeat
(declaration kind: _ @keyword.function)
(lambda "fn" @keyword.function)
(function_type "fn" @keyword.function)
(promise_clause ["exact" "bound" "outside" "inside"] @keyword.modifier)
(lipschitz_clause ["lipschitz" "everywhere"] @keyword.modifier)
(bounds_clause "bounds" @keyword.modifier)
(material_clause "material" @keyword.modifier)
(intersect_clause "intersect" @keyword.modifier)
(copies_clause) @keyword.modifier
(require_clause "require" @keyword.modifier)

[
  "||" "&&" "==" "!=" "<" "<=" ">" ">=" ".." "+" "-" "|" "&" "*" "/" "%" "!" "=" "->" "..."
] @operator

["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," ":" ";" "."] @punctuation.delimiter

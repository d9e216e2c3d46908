; Roles of words, in the names of Zed themes. A later pattern wins over an earlier one.

(comment) @comment
(doc_comment) @comment.doc

(identifier) @variable
((identifier) @variable.special (#eq? @variable.special "p"))
((identifier) @constant (#any-of? @constant "pi" "tau" "inf"))

(field_expression name: (identifier) @property)
(call_expression function: (identifier) @function)
(call_expression
  function: (field_expression name: (identifier) @function.method))

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
["import" "from" "as"] @keyword
["if" "else"] @keyword
["for" "in"] @keyword
(declaration kind: _ @keyword)
(lambda "fn" @keyword)
(function_type "fn" @keyword)
(promise_clause ["exact" "bound" "outside" "inside"] @keyword)
(lipschitz_clause ["lipschitz" "everywhere"] @keyword)
(bounds_clause "bounds" @keyword)
(material_clause "material" @keyword)
(intersect_clause "intersect" @keyword)
(copies_clause) @keyword
(require_clause "require" @keyword)

[
  "||" "&&" "==" "!=" "<" "<=" ">" ">=" ".." "+" "-" "|" "&" "*" "/" "%" "!" "=" "->" "..."
] @operator

["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," ":" ";" "."] @punctuation.delimiter

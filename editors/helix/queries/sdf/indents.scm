[
  (block)
  (arguments)
  (parameters)
  (list)
  (parenthesized_expression)
  (declaration)
] @indent

[")" "]" "}"] @outdent

[
  (block)
  (arguments)
  (parameters)
  (list)
  (record)
  (parenthesized_expression)
  (declaration)
] @indent

[")" "]" "}"] @outdent

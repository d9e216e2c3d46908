; In the words of nvim-treesitter.

[
  (block)
  (arguments)
  (parameters)
  (list)
  (record)
  (parenthesized_expression)
  (declaration)
] @indent.begin

[")" "]" "}"] @indent.branch

; In the words of nvim-treesitter.

[
  (block)
  (arguments)
  (parameters)
  (list)
  (parenthesized_expression)
  (declaration)
] @indent.begin

[")" "]" "}"] @indent.branch

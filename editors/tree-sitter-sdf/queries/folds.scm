[
  (declaration)
  (block)
  (arguments)
  (parameters)
  (list)
  (parenthesized_expression)
] @fold

(doc_comment)+ @fold
(comment)+ @fold
(import)+ @fold

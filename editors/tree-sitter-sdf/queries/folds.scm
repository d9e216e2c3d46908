[
  (declaration)
  (block)
  (arguments)
  (parameters)
  (list)
  (record)
  (parenthesized_expression)
] @fold

(doc_comment)+ @fold
(comment)+ @fold
(import)+ @fold

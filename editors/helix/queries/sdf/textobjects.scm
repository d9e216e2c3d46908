(declaration body: _ @function.inside) @function.around
(parameter) @parameter.inside
(arguments (_) @parameter.inside)
(comment) @comment.inside
(comment)+ @comment.around
(doc_comment) @comment.inside
(doc_comment)+ @comment.around

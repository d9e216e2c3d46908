(block "}" @end) @indent
(arguments ")" @end) @indent
(parameters ")" @end) @indent
(list "]" @end) @indent
(record ")" @end) @indent
(parenthesized_expression ")" @end) @indent
(declaration) @indent

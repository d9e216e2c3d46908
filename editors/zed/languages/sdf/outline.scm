(declaration kind: _ @context name: (identifier) @name) @item
(param "param" @context name: (identifier) @name) @item
(source_file (let "let" @context name: (identifier) @name) @item)

(declaration name: (identifier) @name) @definition.function
(param name: (identifier) @name) @definition.constant
(source_file (let name: (identifier) @name) @definition.constant)
(call_expression function: (identifier) @name) @reference.call
(call_expression
  function: (field_expression name: (identifier) @name)) @reference.call

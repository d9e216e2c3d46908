; Where names are declared, and where they are known.

[
  (source_file)
  (declaration)
  (lambda)
  (block)
  (comprehension)
] @local.scope

(declaration name: (identifier) @local.definition.function)
(param name: (identifier) @local.definition.var)
(let name: (identifier) @local.definition.var)
(parameter name: (identifier) @local.definition.parameter)
(comprehension name: (identifier) @local.definition.var)
(imported_name (identifier) @local.definition.import)

(identifier) @local.reference

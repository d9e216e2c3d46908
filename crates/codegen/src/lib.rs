//! From sdfc graphs to naga modules: lowering, linking, validation, writers, reflection.

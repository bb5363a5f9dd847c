// Nothing: the target needs a source to precompile the headers for.

"""One file per effect; a term is built only if the scene asks for it."""

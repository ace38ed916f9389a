"""From a checked project to the files that a verb writes: which views, which emitter, which target."""

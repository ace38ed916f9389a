"""Edit a project's files by as little text as possible, and prove that nothing else changed."""

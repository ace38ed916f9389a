"""What the verbs print to a terminal."""

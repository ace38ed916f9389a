"""Transform: architecture in, architecture out."""

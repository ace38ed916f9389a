"""The live preview: a project's site from memory, made anew when a file is saved, and answers to "what if"."""

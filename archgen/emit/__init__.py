"""Emit: writers. They take the four plain shapes of views and give files."""

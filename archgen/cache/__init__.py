"""Folders of files that a later run may use again: safe to delete, never part of the output."""

"""Elements get another name or another place, in all files at once: planned as edits of texts, proved by comparing models."""

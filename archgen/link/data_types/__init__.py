"""Types with fields: read, made of generic types, checked, and turned into definitions of messages."""

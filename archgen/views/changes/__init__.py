"""A comparison as a document: what is said of it, in which order, and the outline that pages are made from."""

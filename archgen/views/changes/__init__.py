"""A comparison as a document: the wording shared by all formats, and the outline that pages are made from."""

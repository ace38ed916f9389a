"""Start: the files of a new project, made from a few answers or from a spreadsheet."""

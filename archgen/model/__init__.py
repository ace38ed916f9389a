"""The model: the elements of an architecture as frozen plain data. It knows nothing of files or formats."""

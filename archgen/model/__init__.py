"""The model: what an architecture consists of, as frozen plain data. It knows nothing of files or formats."""

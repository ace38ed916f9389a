"""What all importers of other tools' models share: what they return, safe reading, and the table of formats."""

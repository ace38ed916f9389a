"""Write generated files into a folder that holds other people's files too."""

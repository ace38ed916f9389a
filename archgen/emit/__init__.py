"""Writers: from the plain shapes of the views to the bytes of files."""

"""Link: slices are merged, elements declared, references resolved; the architecture comes out."""

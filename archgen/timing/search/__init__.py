"""What is found by trying: how things would have to run for chains to be in time, and how much each element may take."""

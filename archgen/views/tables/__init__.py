"""Tables of the whole architecture: lists, statistics, requirements."""

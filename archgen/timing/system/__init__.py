"""The second stage: the architecture as activities, arcs, cores and messages."""

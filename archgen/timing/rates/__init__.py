"""The fourth stage: how often everything works, from sources to sinks."""

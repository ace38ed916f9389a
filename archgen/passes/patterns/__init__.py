"""Passes written as patterns in the language's own words: files that say what to find, and what to write there."""

"""Markdown for pull requests and wikis, with every character of a user's text made inert."""

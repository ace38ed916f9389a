"""The view `uml`: the architecture as a tree of elements that a template writes as XMI."""

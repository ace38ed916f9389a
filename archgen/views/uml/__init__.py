"""The architecture as a model of UML: a tree of elements that a template writes as XMI."""

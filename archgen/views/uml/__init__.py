"""The architecture as a model of UML: a tree of elements that a template writes as XMI."""

from archgen.views.uml.uml_view import make_uml_view

__all__ = ["make_uml_view"]

"""Read UML models in XMI 2.x: component and deployment diagrams with their classes become slices of the language."""

from archgen.importers.xmi.xmi_import import read_xmi

__all__ = ["read_xmi"]

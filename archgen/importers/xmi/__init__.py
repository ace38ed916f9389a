"""Read UML models in XMI 2.x: component and deployment diagrams with their classes become slices of the language."""

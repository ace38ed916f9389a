"""The architecture as rules and importers meet it: its elements, selectors, quantities."""

from archgen.model.architecture import Architecture, Chain, UseCase
from archgen.model.component import Component, ComponentType, Connection, Group, Input, Output
from archgen.model.deployment import Container, Host, Link, Resource
from archgen.model.generic_names import read_generic_name
from archgen.model.node import Endpoint, Node, Topic, UseKind
from archgen.model.parameter import MAX_NAME_LENGTH, Parameter
from archgen.model.port_media import MEDIUM_NAMES
from archgen.model.quantity import MAX_DIGITS, Quantity, parse_quantity
from archgen.model.requirement import Requirement
from archgen.model.selector_evaluation import Selection, evaluate_selector

__all__ = [
    "MAX_DIGITS",
    "MAX_NAME_LENGTH",
    "MEDIUM_NAMES",
    "Architecture",
    "Chain",
    "Component",
    "ComponentType",
    "Connection",
    "Container",
    "Endpoint",
    "Group",
    "Host",
    "Input",
    "Link",
    "Node",
    "Output",
    "Parameter",
    "Quantity",
    "Requirement",
    "Resource",
    "Selection",
    "Topic",
    "UseCase",
    "UseKind",
    "evaluate_selector",
    "parse_quantity",
    "read_generic_name",
]

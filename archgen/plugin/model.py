"""The architecture as rules, importers and generators meet it: its elements, selectors, quantities."""

from archgen.model.architecture import Architecture, Chain, Partner, UseCase
from archgen.model.component import Component, ComponentType, Connection, Group, Input, Output
from archgen.model.declared_timing import Timing
from archgen.model.deployment import Container, Host, Link, Resource
from archgen.model.element_annotations import ElementAnnotations
from archgen.model.generic_names import read_generic_name
from archgen.model.graph_search import find_rings
from archgen.model.message_types import PART_KEYS, ConceptualType, DataField, flow_of
from archgen.model.node import PHASES, Endpoint, FlowKind, Node, Qos, Topic, UseKind, qos_profile
from archgen.model.parameter import MAX_NAME_LENGTH, Operation, Parameter, is_parameter_name
from archgen.model.parameter_values import canonical_name, find_declarations
from archgen.model.port_media import DIGITAL, MEDIUM_NAMES, flow_of_port, is_physical, uses_ros, word_of_medium
from archgen.model.process_scheduling import NO_SCHEDULING, ProcessScheduling, read_scheduling
from archgen.model.quantity import MAX_DIGITS, Quantity, parse_quantity
from archgen.model.requirement import Requirement
from archgen.model.selector_evaluation import Selection, evaluate_selector

__all__ = ["DIGITAL", "MAX_DIGITS", "MAX_NAME_LENGTH", "MEDIUM_NAMES", "NO_SCHEDULING", "PART_KEYS", "PHASES"]
__all__ += ["Architecture", "Chain", "Component", "ComponentType", "ConceptualType", "Connection", "Container"]
__all__ += ["DataField", "ElementAnnotations", "Endpoint", "FlowKind", "Group", "Host", "Input", "Link", "Node"]
__all__ += ["Operation", "Output", "Parameter", "Partner", "ProcessScheduling", "Qos", "Quantity", "Requirement"]
__all__ += ["Resource", "Selection", "Timing", "Topic", "UseCase", "UseKind", "canonical_name", "evaluate_selector"]
__all__ += ["find_declarations", "find_rings", "flow_of", "flow_of_port", "is_parameter_name", "is_physical"]
__all__ += ["parse_quantity", "qos_profile", "read_generic_name", "read_scheduling", "uses_ros", "word_of_medium"]

"""What archgen knows of ROS: distributions, messages and interface files, names, files of parameters."""

from archgen.derivation.ros_names import shared_topic_names
from archgen.derivation.wire.wire_names import expand_name, find_name_fault, find_node_name_fault
from archgen.link.data_types.message_definitions import spell_message_name
from archgen.link.interface_sources import load_interfaces
from archgen.link.parameter_texts import (
    ParameterSection,
    ParameterText,
    flatten_parameters,
    matches_node_name,
    read_parameter_text,
)
from archgen.link.shipped_interfaces import load_shipped_interfaces
from archgen.model.common_callbacks import is_common_callback
from archgen.model.known_interfaces import KNOWN_DISTROS, Interface, InterfaceConstant, InterfaceField
from archgen.model.message_types import full_message_name
from archgen.model.ros_distro import PAST_DISTROS, is_ros_1
from archgen.syntax.interface_definitions import INVALID_INTERFACE, parse_interface_definition

__all__ = ["INVALID_INTERFACE", "KNOWN_DISTROS", "PAST_DISTROS", "Interface", "InterfaceConstant", "InterfaceField"]
__all__ += ["ParameterSection", "ParameterText", "expand_name", "find_name_fault", "find_node_name_fault"]
__all__ += ["flatten_parameters", "full_message_name", "is_common_callback", "is_ros_1", "load_interfaces"]
__all__ += ["load_shipped_interfaces", "matches_node_name", "parse_interface_definition", "read_parameter_text"]
__all__ += ["shared_topic_names", "spell_message_name"]

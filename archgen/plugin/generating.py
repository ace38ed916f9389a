"""For generators: what views are made from and give back, names in other languages, and what the views of several programs share."""

from archgen.analyses.topic_sources import find_endpoint_span
from archgen.bringup.program_names import (
    ProgramNames,
    find_node_language,
    group_by_program,
    index_endpoints,
    is_loadable,
    list_generated_nodes,
    name_endpoints,
    name_package,
    name_plugin,
)
from archgen.model.code_names import (
    AADL_KEYWORDS,
    CPP_KEYWORDS,
    PYTHON_KEYWORDS,
    list_name_words,
    make_camel_name,
    make_identifier_in,
    make_lower_camel_name,
    make_ros_name,
    make_snake_name,
)
from archgen.model.element_ids import make_id, spell_in_ascii
from archgen.model.path_resolver import title_from_id
from archgen.views.generation.architecture_needs import find_name_clashes, find_text_fault
from archgen.views.generation.component_records import (
    SetParameter,
    find_type_words,
    list_set_parameters,
    read_own_hints,
)
from archgen.views.generation.generation_context import (
    NOT_GENERATED,
    GeneratedView,
    GenerationContext,
    tell_left_out,
    write_place,
)
from archgen.views.generation.program_parts import (
    PORT_SECTIONS,
    convert_ros_value,
    find_program_type,
    infer_ros_type,
    list_node_values,
    record_parameters,
    record_ports,
    record_qos,
)
from archgen.views.lookup import collect_messages
from archgen.views.records.record_sources import to_plain

__all__ = ["AADL_KEYWORDS", "CPP_KEYWORDS", "NOT_GENERATED", "PORT_SECTIONS", "PYTHON_KEYWORDS", "GeneratedView"]
__all__ += ["GenerationContext", "ProgramNames", "SetParameter", "collect_messages", "convert_ros_value"]
__all__ += [
    "find_endpoint_span",
    "find_name_clashes",
    "find_node_language",
    "find_program_type",
    "find_text_fault",
    "find_type_words",
]
__all__ += ["group_by_program", "index_endpoints", "infer_ros_type", "is_loadable", "list_generated_nodes"]
__all__ += ["list_name_words", "list_node_values", "list_set_parameters", "make_camel_name", "make_id"]
__all__ += ["make_identifier_in", "make_lower_camel_name", "make_ros_name", "make_snake_name", "name_endpoints"]
__all__ += ["name_package", "name_plugin", "read_own_hints", "record_parameters", "record_ports"]
__all__ += ["record_qos", "spell_in_ascii", "tell_left_out", "title_from_id", "to_plain", "write_place"]

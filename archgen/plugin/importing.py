"""For importers: what they return, reading files within limits, ids and titles, trees of YAML and XML with their places."""

from archgen.conformance.observed_robot import ObservedEndpoint, ObservedNode, ObservedRobot, RecordedTopic
from archgen.diagnostics import NO_SPAN, SourceTexts, Span, find_closest
from archgen.importers.foreign_files import (
    ARCHIVE_DAMAGE,
    ZIP_BEGINNING,
    XmlElement,
    XmlEvents,
    XmlProblem,
    explain_encoding,
    explain_syntax,
    limit_unpacked,
    parse_xml,
    read_archive_members,
    read_bounded,
)
from archgen.importers.foreign_import import (
    MAX_OFFICE_BYTES,
    ForeignFileError,
    ForeignImport,
    ImportedRequirements,
    ImportedTables,
    ImportNote,
    ObjectAccount,
    ReadRecordings,
    RecordingRefusedError,
)
from archgen.importers.robot_observation import DesignedStart, ObservationOptions
from archgen.importers.work_budget import CHARACTERS_IN_A_STEP, STEPS_OF_A_KEPT_VALUE, WorkBudget
from archgen.model.code_names import make_camel_name
from archgen.model.element_ids import MAX_ID_LENGTH, is_id, make_id, make_unique_id, spell_in_ascii
from archgen.model.path_resolver import title_from_id
from archgen.pipeline import link_slices
from archgen.project.library_reading import find_program_name, index_shipped_programs, load_shipped_component_types
from archgen.regular_files import open_named_file
from archgen.resources import worker_environment
from archgen.syntax.project_files import MAX_BYTES
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode, node_to_data, resolve_scalar
from archgen.syntax.yaml_writer import FlowMapping, needs_quotes

__all__ = ["ARCHIVE_DAMAGE", "CHARACTERS_IN_A_STEP", "MAX_BYTES", "MAX_ID_LENGTH", "MAX_OFFICE_BYTES", "NO_SPAN"]
__all__ += ["STEPS_OF_A_KEPT_VALUE", "ZIP_BEGINNING", "FlowMapping", "ForeignFileError", "ForeignImport", "ImportNote"]
__all__ += ["ImportedRequirements", "ImportedTables", "MappingNode", "ObjectAccount", "ObservationOptions"]
__all__ += ["DesignedStart", "ObservedEndpoint", "ObservedNode", "ObservedRobot", "ReadRecordings", "RecordedTopic"]
__all__ += ["RecordingRefusedError", "ScalarNode", "SequenceNode", "SourceTexts", "Span", "WorkBudget", "XmlElement"]
__all__ += ["XmlEvents", "XmlProblem", "YamlNode", "explain_encoding", "explain_syntax", "find_closest"]
__all__ += ["find_program_name", "index_shipped_programs", "is_id", "limit_unpacked", "link_slices"]
__all__ += ["load_shipped_component_types"]
__all__ += ["make_camel_name", "make_id", "make_unique_id", "needs_quotes", "node_to_data", "open_named_file"]
__all__ += ["parse_xml", "parse_yaml", "read_archive_members", "read_bounded", "resolve_scalar", "spell_in_ascii"]
__all__ += ["title_from_id", "worker_environment"]

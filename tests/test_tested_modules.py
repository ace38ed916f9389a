"""Every module with logic has tests that import it, cases that are named after it, or a test file that says it covers it."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
ROOT = TESTS.parent
ROOMS = ("link", "analyses", "transform", "model", "schema", "syntax", "project")
COVERED_BY = {
    "link.declare.group_declaration": "link/test_element_declaration.py",
    "link.declare.node_declaration": "link/test_element_declaration.py",
    "link.declare.section_declaration": "link/test_element_declaration.py",
    "link.declare.timing_declaration": "link/test_element_declaration.py",
    "link.declare.type_declaration": "link/test_element_declaration.py",
    "link.merged_timing": "link/test_project_linking.py",
    "link.project_packing": "link/test_project_packing.py",
    "link.sanity_checks": "link/cases/timing.txt",
    "transform.low_level": "transform/test_low_level.py",
    "transform.planned_nodes": "transform/test_low_level.py",
    "transform.portless_endpoints": "transform/test_endpoints.py",
    "transform.reading_endpoints": "transform/test_endpoints.py",
    "transform.writing_endpoints": "transform/test_endpoints.py",
    "model.ros_distro": "model/test_known_interfaces.py",
    "model.selector_parser": "model/test_selector_evaluation.py",
    "schema.reading_rules": "cases/reading.txt",
    "schema.schema_wording": "schema/test_schema_validation.py",
    "schema.short_forms": "schema/test_short_forms.py",
    "syntax.committed_files": "project/test_project_tracking.py",
    "syntax.file_patterns": "project/test_project_tracking.py",
    "syntax.interface_literals": "syntax/test_interface_definitions.py",
    "syntax.interface_types": "syntax/test_interface_definitions.py",
    "syntax.yaml_comments": "syntax/test_yaml_parser.py",
    "syntax.yaml_errors": "syntax/test_yaml_parser.py",
    "project.project_loading": "project/test_project_tracking.py",
    "project.project_search": "project/test_project_tracking.py",
    "project.project_tracking": "project/test_project_tracking.py",
    "project.slice_parsing": "project/test_project_tracking.py",
    "project.source_reading": "project/test_project_tracking.py",
}
"""The tests of modules that no test imports: they work through the function that the room offers."""


def _has_logic(module: Path) -> bool:
    """Whether a module holds a function with more than a docstring."""
    functions = (
        node for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))) if isinstance(node, ast.FunctionDef)
    )
    return any(ast.get_docstring(function) is None or len(function.body) > 1 for function in functions)


MODULES = {
    ".".join(path.relative_to(ROOT / "archgen").with_suffix("").parts): path
    for room in ROOMS
    for path in sorted((ROOT / "archgen" / room).rglob("*.py"))
    if path.name != "__init__.py" and _has_logic(path)
}


@pytest.fixture(scope="module")
def imported_modules() -> frozenset[str]:
    """Return the dotted names that the tests import."""
    names = set[str]()
    for file in TESTS.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            elif isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
    return frozenset(names)


@pytest.mark.parametrize("module", MODULES)
def test_a_module_has_tests(module: str, imported_modules: frozenset[str]) -> None:
    room, *_, name = module.split(".")
    has_cases = (TESTS / room / "cases" / f"{name}.txt").is_file()
    is_covered = module in COVERED_BY and (TESTS / COVERED_BY[module]).is_file()
    assert f"archgen.{module}" in imported_modules or has_cases or is_covered, "write tests, or say which ones cover it"


@pytest.mark.parametrize("module", COVERED_BY)
def test_what_is_covered_is_a_module_that_no_test_imports(module: str, imported_modules: frozenset[str]) -> None:
    assert module in MODULES
    assert f"archgen.{module}" not in imported_modules, "it needs no entry"

"""Each fact about a component type that ships has its source: address, version, date and kind."""

from __future__ import annotations

import datetime as dt
import re

import pytest

from archgen import resources
from archgen.link import mapping_values
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.project.library_reading import load_shipped_component_types
from archgen.project.shipped_sources import SOURCE_KINDS, ShippedSource, read_shipped_sources
from archgen.syntax.yaml_parser import parse_yaml
from tests.project.shipped_facts import list_type_facts


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_each_fact_has_exactly_one_source_and_no_source_is_for_nothing(distro: str) -> None:
    types, sources = load_shipped_component_types(distro), read_shipped_sources(distro)
    assert list(sources) == list(types), "types and sources, in the order of their names"
    for name, entry in types.items():
        facts = sorted(list_type_facts(mapping_values.get_body(entry)))
        sourced_facts = sorted(fact for source in sources[name] for file in source.files.values() for fact in file)
        assert sourced_facts == facts, name


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_each_source_says_where_which_version_when_and_what_it_is(distro: str) -> None:
    for name, sources in read_shipped_sources(distro).items():
        assert sources, name
        for source in sources:
            assert re.fullmatch(r"https://[\w.-]+/[\w./-]+[\w]", source.address), (name, source)
            assert re.fullmatch(r"\d+(\.\d+)+", source.version), (name, source)
            assert re.fullmatch(r"\d+(\.\d+)+", source.released), (name, source)
            assert re.fullmatch(r"[0-9a-f]{40}", source.commit), (name, source)
            assert dt.date(2007, 1, 1) < dt.date.fromisoformat(source.date), (name, source)
            assert source.kind in SOURCE_KINDS, (name, source)
            for file, lines in source.files.items():
                assert not file.startswith("/"), (name, source)
                assert lines, (name, file)
                assert all(isinstance(line, int) and line > 0 for line in lines.values()), (name, file)


def test_there_are_sources_for_the_distributions_and_for_no_other() -> None:
    files = {path.name for path in resources.resource_path("ros_library", "sources").iterdir()}
    assert files == {f"{distro}.yaml" for distro in KNOWN_DISTROS}


def test_a_link_leads_to_a_line_of_a_commit() -> None:
    source = ShippedSource("https://example.org/it", "1.2", "1.3", "c0ffee", "2026-01-31", "source text", {})
    assert source.format_link() == "https://example.org/it/tree/c0ffee"
    assert source.format_link("src/it.cpp") == "https://example.org/it/blob/c0ffee/src/it.cpp"
    assert source.format_link("src/it.cpp", 12) == "https://example.org/it/blob/c0ffee/src/it.cpp#L12"


def test_facts_are_what_a_package_can_say() -> None:
    document, _ = parse_yaml(
        "it.yaml",
        "inputs: {scan: {type: sensor_msgs/msg/LaserScan}, keys: {type: Keys, medium: physical}}\n"
        "outputs: {map: {type: nav_msgs/msg/OccupancyGrid}}\n"
        "operations: {reset: {description: reset}}\n"
        "parameters: {rate: {type: float, value: 1.0}, cloud: {enable: false}, name: it}\n"
        "node: {package: it, executable: it_node}\n",
    )
    assert document is not None
    assert list(list_type_facts(document.root)) == [
        "executable",
        "inputs.scan",
        "outputs.map",
        "operations.reset",
        "parameters.rate",
        "parameters.cloud.enable",
        "parameters.name",
    ]

"""What a port is, by the word for its medium."""

from __future__ import annotations

import pytest

from archgen.model.component import Input, Output
from archgen.model.message_types import ConceptualType
from archgen.model.port_media import (
    flow_of_port,
    is_physical,
    label_of_medium,
    list_medium_words,
    name_medium,
    nature_of,
    normalise_medium,
    uses_ros,
    word_of_medium,
)


def port(medium: str) -> Output:
    return Output("g.c.o", "o", "g.c", medium=medium)


@pytest.mark.parametrize(
    ("medium", "nature", "word", "label", "words"),
    [
        ("ros", "ros", "digital", "", ("digital", "ros")),
        ("physical", "physical", "physical", "physical", ("physical",)),
        ("mqtt", "other", "mqtt", "MQTT", ("digital", "mqtt")),
        ("homebrew", "other", "homebrew", "homebrew", ("digital", "homebrew")),
    ],
)
def test_a_port_is_told_by_its_word(medium: str, nature: str, word: str, label: str, words: tuple[str, ...]) -> None:
    output = port(medium)
    assert (nature_of(output), word_of_medium(output), label_of_medium(output)) == (nature, word, label)
    assert list_medium_words(output) == words
    assert (uses_ros(output), is_physical(output)) == (nature == "ros", nature == "physical")


def test_a_port_that_says_nothing_is_ros() -> None:
    assert nature_of(Input("g.c.i", "i", "g.c")) == "ros"


@pytest.mark.parametrize(
    ("text", "word"),
    [
        (None, None),
        ("", None),
        ("digital", None),
        ("Digital", None),
        ("MQTT", "mqtt"),
        (" ros ", "ros"),
        ("x/y", "x/y"),
    ],
)
def test_capitals_do_not_count_and_digital_names_no_way(text: str | None, word: str | None) -> None:
    assert normalise_medium(text) == word


def test_running_text_writes_media_as_people_do() -> None:
    assert [name_medium(word) for word in ("ethercat", "serial", "fleetlink")] == ["EtherCAT", "serial", "fleetlink"]


@pytest.mark.parametrize(
    ("medium", "carried_type", "flow"),
    [
        ("ros", None, "topic"),
        ("ros", ConceptualType("T", "std_srvs/srv/Trigger"), "service"),
        ("ros", ConceptualType("T", "a/action/B"), "action"),
        # Which message a type with parts will have is not known yet where it is ROS.
        ("ros", ConceptualType("T", request="Q"), "topic"),
        ("rest", ConceptualType("T", request="Q"), "service"),
        ("rest", ConceptualType("T", response="Q"), "service"),
        ("rest", ConceptualType("T", request="Q", feedback="F"), "action"),
        ("rest", ConceptualType("T", "std_srvs/srv/Trigger"), "service"),
        ("mqtt", ConceptualType("T", "std_msgs/msg/String"), "topic"),
        ("physical", ConceptualType("T", "std_srvs/srv/Trigger"), "topic"),
    ],
)
def test_what_is_asked_and_answered_is_a_call_over_any_medium(
    medium: str, carried_type: ConceptualType | None, flow: str
) -> None:
    assert flow_of_port(port(medium), carried_type) == flow

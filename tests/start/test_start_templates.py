"""What a new project begins with: a flow from a sensor to an actuator, whatever groups the user names."""

from __future__ import annotations

from dataclasses import replace

import pytest
import yaml

from archgen.schema import validate_document
from archgen.start import project_plan, start_answers, start_templates
from archgen.start.start_answers import GroupAnswer
from archgen.syntax import yaml_parser


@pytest.mark.parametrize(
    ("names", "kinds"),
    [
        (("one",), [["sensor", "step", "actuator"]]),
        (("one", "two"), [["sensor"], ["step", "actuator"]]),
        (("one", "two", "three"), [["sensor"], ["step"], ["actuator"]]),
        (("one", "two", "three", "four"), [["sensor"], ["step"], ["step"], ["actuator"]]),
    ],
)
def test_the_example_flows_from_the_first_group_to_the_last(names: tuple[str, ...], kinds: list[list[str]]) -> None:
    answers = replace(start_answers.collect_answers("robot"), groups=tuple(GroupAnswer(name, name) for name in names))
    files = start_templates.fill_group_files(answers)
    components = [
        yaml.safe_load(data)["groups"][name]["components"] for name, data in zip(names, files.values(), strict=True)
    ]
    assert [len(each) for each in components] == [len(each) for each in kinds]
    checked = project_plan.judge_files(project_plan.example_files(answers), "robot")
    assert [finding for finding in checked.findings if finding.severity == "error"] == []
    assert len(checked.architecture.connections) == sum(map(len, kinds)) - 1


@pytest.mark.parametrize("title", ["A: b", "# x", "'", "[[ 7 * 7 ]]", "{% x %}", "a\nb", "機械"])
def test_any_title_is_text_and_nothing_else(title: str) -> None:
    answers = replace(start_answers.collect_answers("robot"), title=title)
    data = yaml.safe_load(start_templates.fill_project_file(answers))
    assert " ".join(data["project"]["title"].split()) == " ".join(title.split())
    assert b"49" not in start_templates.fill_readme(answers)


@pytest.mark.parametrize("folder", ["", "robot", "a b", "${{ secrets.X }}", "ro'bot"])
def test_a_folder_is_no_expression_of_a_workflow(folder: str) -> None:
    workflow = start_templates.fill_workflow(folder).decode()
    yaml.safe_load(workflow)
    assert "${{ secrets" not in workflow
    assert ("paths:" in workflow) == (folder == "robot")


def test_two_projects_of_a_repository_have_nothing_in_common_that_could_clash() -> None:
    first, second = (yaml.safe_load(start_templates.fill_workflow(f"robots/{name}")) for name in ("alpha", "beta"))
    assert (
        first["concurrency"]["group"]
        == "architecture-robots/alpha-${{ github.event_name == 'pull_request' && github.ref || github.run_id }}"
    )
    assert (
        second["concurrency"]["group"]
        == "architecture-robots/beta-${{ github.event_name == 'pull_request' && github.ref || github.run_id }}"
    )
    assert [each["name"] for each in (first, second)] == ["Architecture of robots/alpha", "Architecture of robots/beta"]
    keys = [each["jobs"]["comment"]["steps"][0]["with"]["key"] for each in (first, second)]
    assert keys == ["diff/robots-alpha", "diff/robots-beta"]


@pytest.mark.parametrize("folder", ["", "a b", "${{ secrets.X }}"])
def test_open_requests_are_held_against_each_other_each_night(folder: str) -> None:
    text = start_templates.fill_nightly_workflow(folder).decode()
    workflow = yaml.safe_load(text)
    assert "${{ secrets" not in text
    assert workflow[True]["schedule"] == [{"cron": "23 2 * * *"}]
    check, comment = (workflow["jobs"][name]["steps"][-1]["with"] for name in ("check", "comment"))
    assert check.pop("project", "") == folder.replace("${{", "${{ '${{' }}")
    assert check == {"requests": "true"}
    assert comment["file"] == "requests.json"
    assert comment["key"].startswith("requests")
    # Whoever reads what strangers wrote may write nothing.
    assert set(workflow["jobs"]["check"]["permissions"].values()) == {"read"}


@pytest.mark.parametrize("folder", ["", "robot"])
def test_a_merge_queue_is_answered(folder: str) -> None:
    triggers = yaml.safe_load(start_templates.fill_workflow(folder))[True]
    assert triggers["merge_group"] is None


def test_only_one_project_publishes() -> None:
    jobs = [yaml.safe_load(start_templates.fill_workflow("a", publishes=each))["jobs"] for each in (True, False)]
    assert [list(each) for each in jobs] == [["check", "comment", "publish"], ["check", "comment"]]


@pytest.mark.parametrize(("folder", "written"), [("", "."), ("$HOME", "$$HOME"), ("robot", "robot")])
def test_a_folder_is_no_variable_of_a_pipeline(folder: str, written: str) -> None:
    assert written in start_templates.fill_pipeline(folder).decode()
    yaml.safe_load(start_templates.fill_pipeline(folder))


def test_agreements_load_whatever_the_partner_is_called() -> None:
    text = start_templates.fill_agreements("A: B # {{ c }}\u2028- d\x1b").decode()
    document, diagnostics = yaml_parser.parse_yaml("review/a.yaml", text)
    assert document is not None
    assert (diagnostics, validate_document(document)) == ((), ())
    assert "$schema=" in text.splitlines()[0]
    assert "$schema=" not in start_templates.fill_agreements("A", has_schema=False).decode()

"""`archgen simulate`: the same figures each time, as the schema describes them."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
from click.testing import CliRunner

from archgen import resources
from archgen.cli import main

PROJECT = """
groups:
  g:
    components:
      eye: {outputs: {seen: {type: Seen}}, timing: {period: 10 ms, wcet: 2 ms, bcet: 1 ms}}
      hand: {inputs: {seen: eye.seen}, outputs: {moved: {medium: physical}}, timing: {wcet: 3 ms}}
types: {Seen: {message: std_msgs/msg/Empty}}
chains: {reach: {through: [eye, hand], deadline: {always: 20 ms, 50 %: 5 ms}}}
"""


def told(tmp_path: Path, *words: str) -> str:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT, encoding="utf-8")
    return CliRunner().invoke(main, ["simulate", str(file), "--seconds", "2", "--seeds", "3", *words]).stdout


def test_json_is_as_the_schema_says(tmp_path: Path) -> None:
    schema = json.loads(resources.resource_path("schemas", "simulation.schema.json").read_text(encoding="utf-8"))
    data = json.loads(told(tmp_path, "--format", "json"))
    jsonschema_rs.validator_for(schema).validate(data)
    chain = data["chains"]["reach"]
    assert chain["deadline_shares"] == [
        {"share": "50 %", "limit": 5.0, "seen": chain["reaction"]["median"], "verdict": "late"}
    ]
    assert chain["bound"] == 15
    assert 14 < chain["reaction"]["max"] <= 15


def test_the_same_seeds_give_the_same_text(tmp_path: Path) -> None:
    first = told(tmp_path)
    assert first == told(tmp_path)
    assert "What was seen is no bound" in first
    assert "reach reaction" in first


def test_an_unknown_chain_is_wrong_usage(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT, encoding="utf-8")
    found = CliRunner().invoke(main, ["simulate", str(file), "--chain", "raech"])
    assert (found.exit_code, "did you mean `reach`" in found.stderr) == (2, True)


def _run(tmp_path: Path, project: str, *words: str) -> tuple[int, str]:
    file = tmp_path / "robot.yaml"
    file.write_text(project, encoding="utf-8")
    found = CliRunner().invoke(main, ["simulate", str(file), *words])
    return found.exit_code, found.stdout + found.stderr


def test_json_says_what_was_taken_for_granted(tmp_path: Path) -> None:
    said = json.loads(told(tmp_path, "--format", "json"))["assumptions"]
    assert {one["figure"]: (one["taken"], one["of"]) for one in said["defaults"]} == {
        "bcet": ("0", ["hand"]),
        "jitter": ("none", ["eye"]),
        "host": ("a core of its own", ["eye", "hand"]),
    }
    assert "execution times from bcet to wcet" in said["random"]
    assert "lost packets" in said["not_simulated"]


def test_without_timing_it_says_what_is_missing(tmp_path: Path) -> None:
    status, said = _run(tmp_path, "groups: {g: {components: {a: {outputs: {o: {type: T}}}}}}\ntypes: {T: {}}\n")
    assert status == 0
    assert "Nothing ran: no element has a period or a rate" in said


def test_a_ring_without_end_is_refused(tmp_path: Path) -> None:
    ring = PROJECT.replace("eye: {outputs", "eye: {inputs: {x: {from: eye.seen}}, outputs").replace(
        "timing: {period: 10 ms, wcet: 2 ms", "timing: {behaviour: event, wcet: 2 ms"
    )
    status, said = _run(tmp_path, ring)
    assert status != 0
    assert "round for ever in eye > eye" in said


def test_wrong_figures_are_wrong_usage(tmp_path: Path) -> None:
    for words in (("--seconds", "0"), ("--seeds", "x"), ("--seeds", "-1")):
        status, said = _run(tmp_path, PROJECT, *words)
        assert status == 2
        assert words[0] in said


def test_a_chain_that_is_not_there_names_those_that_are(tmp_path: Path) -> None:
    assert "the chains are reach" in _run(tmp_path, PROJECT, "--chain", "walk")[1]


def test_one_seed_alone_shows_its_own_run_again(tmp_path: Path) -> None:
    alone, again = (json.loads(told(tmp_path, "--seed", "2", "--format", "json")) for _ in range(2))
    assert alone == again
    assert (alone["seeds"], alone["first_seed"]) == (1, 2)
    together = json.loads(told(tmp_path, "--format", "json"))
    largest = together["chains"]["reach"]["reaction"]["max"]
    each = [json.loads(told(tmp_path, "--seed", str(seed), "--format", "json")) for seed in range(3)]
    assert largest == max(one["chains"]["reach"]["reaction"]["max"] for one in each)
    assert together["events"] == sum(one["events"] for one in each)
    assert "from seed 2:" in told(tmp_path, "--seed", "2")


FUSED = """
groups:
  g:
    components:
      camera: {outputs: {image: {type: Seen}}, timing: {period: 33 ms, wcet: 2 ms, bcet: 2 ms}}
      lidar: {outputs: {cloud: {type: Seen}}, timing: {period: 50 ms, wcet: 1 ms, bcet: 1 ms}}
      fusion:
        inputs: {image: camera.image, cloud: lidar.cloud}
        outputs: {fused: {type: Seen}}
        timing: {wcet: 3 ms, trigger: {match: [image, cloud], within: 15 ms}}
      guard:
        inputs: {fused: {from: fusion.fused, freshness: 90 ms}}
        outputs: {moved: {medium: physical}}
        timing: {behaviour: periodic, period: 20 ms, wcet: 1 ms}
types: {Seen: {message: std_msgs/msg/Empty}}
chains: {see: {through: [camera, fusion, guard]}}
"""


def test_it_shows_how_old_and_how_far_apart_what_was_matched_is(tmp_path: Path) -> None:
    status, said = _run(tmp_path, FUSED, "--seconds", "5", "--seeds", "2")
    assert status == 0, said
    lines = said.splitlines()
    matched = next(line for line in lines if line.startswith("  fusion") and line.endswith("15.000"))
    oldest, apart, within = (float(word) for word in matched.split()[1:])
    assert 0 < apart <= within == 15
    assert oldest > apart
    read = next(line for line in lines if line.startswith("  guard <- "))
    assert read.endswith("90.000")
    status, data = _run(tmp_path, FUSED, "--seconds", "5", "--seeds", "2", "--format", "json")
    elements = json.loads(data)["elements"]
    assert (elements["fusion"]["fused"]["largest_age"], elements["camera"]["fused"]) == (oldest, None)
    assert list(elements["guard"]["read_ages"].values()) == [float(read.split()[-2])]


def _trace(tmp_path: Path, *words: str) -> tuple[int, str]:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT, encoding="utf-8")
    ran = CliRunner().invoke(main, ["simulate", str(file), "--seconds", "2", "--seeds", "3", *words])
    return ran.exit_code, ran.stderr


def test_the_latest_run_of_a_chain_is_written(tmp_path: Path) -> None:
    target = tmp_path / "late.json"
    code, said = _trace(tmp_path, "--chain", "reach", "--trace", str(target))
    assert (code, "wrote" in said) == (0, True)
    about = json.loads(target.read_text(encoding="utf-8"))["otherData"]
    data = json.loads(told(tmp_path, "--format", "json", "--chain", "reach"))
    assert about["longest_ms"] == max(data["chains"]["reach"][each]["max"] for each in ("reaction", "age"))
    # JSON on standard output stays JSON, and the run named in it is the same one.
    again = json.loads(told(tmp_path, "--format", "json", "--chain", "reach", "--trace", str(target)))
    assert again == data
    assert told(tmp_path, "--seed", str(about["seed"]), "--chain", "reach").count("14.") > 0


def test_a_trace_is_of_one_chain_on_which_something_passes(tmp_path: Path) -> None:
    target = tmp_path / "late.json"
    assert _trace(tmp_path, "--trace", str(target))[0] == 2
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT.replace("period: 10 ms, ", ""), encoding="utf-8")
    ran = CliRunner().invoke(main, ["simulate", str(file), "--chain", "reach", "--trace", str(target)])
    assert ran.exit_code == 1
    assert "nothing passed along the chain reach" in ran.stderr
    assert not target.exists()


def test_a_trace_replaces_no_file_of_the_project(tmp_path: Path) -> None:
    code, said = _trace(tmp_path, "--chain", "reach", "--trace", str(tmp_path / "robot.yaml"))
    assert code != 0
    assert "is a file of the project itself" in said
    assert (tmp_path / "robot.yaml").read_text(encoding="utf-8") == PROJECT
    assert _trace(tmp_path, "--chain", "reach", "--trace", str(tmp_path / "no" / "\0late.json"))[0] != 0

"""`--set` of what is no single figure of `timing`: processes, hosts, resources, and parts of `timing`."""

from __future__ import annotations

import pytest

from archgen.link.process_overrides import OverrideError
from archgen.link.timing_overrides import apply_overrides
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import Timing, Trigger
from tests.timing.random_systems import architecture

TEXT = """
groups:
  g:
    components:
      eye: {outputs: {image: std_msgs/msg/String, cloud: std_msgs/msg/Bool}}
      mind: {inputs: {image: eye.image, timing: eye.cloud}, outputs: {told: std_msgs/msg/Empty}}
      fast: {inputs: {told: mind.told}}
      slow: {inputs: {told: mind.told}}
nodes:
  eye: {implements: eye, container: box, timing: {wcet: {max: 4 ms, p50: 1 ms}, cores: [2, 3], uses: {gpu: {max: 6 ms, min: 2 ms}}}}
  mind: {implements: mind, host: pc, timing: {core: 1, inputs: {image: {wcet: 3 ms, bcet: 1 ms}}}}
  hands: {implements: [fast, slow], callback_groups: {quick: [fast], lazy: [slow]}}
  twin: {implements: []}
hosts: {pc: {cores: 4, scheduling: {1: fifo}}}
containers: {box: {host: pc}, twin: {threads: 1}}
resources: {gpu: {host: pc}}
"""


def changed(*texts: str) -> Architecture:
    return apply_overrides(architecture(TEXT), texts)


def timing_of(node: str, *texts: str) -> Timing:
    (timing,) = changed(*(f"{node}.timing.{text}" for text in texts)).nodes[node].timing.values()
    return timing


def test_threads_are_those_of_a_container_or_of_a_node_outside_of_one() -> None:
    assert changed("box.threads=2").containers["box"].threads == 2
    assert changed("mind.threads = 3").nodes["mind"].threads == 3
    both = changed("containers.twin.threads=4", "nodes.twin.threads=5")
    assert (both.containers["twin"].threads, both.nodes["twin"].threads) == (4, 5)


def test_a_node_or_a_container_moves_to_another_host() -> None:
    text = TEXT.replace("hosts: {", "hosts: {arm_pc: {cores: 2}, ")

    def moved(override: str) -> tuple[str | None, str | None, str | None]:
        found = apply_overrides(architecture(text), (override,))
        return found.containers["box"].host, found.nodes["eye"].host, found.nodes["mind"].host

    assert moved("mind.host=arm_pc") == ("pc", "pc", "arm_pc")
    assert moved("box.host=arm_pc") == ("arm_pc", "arm_pc", "pc")
    for override, words in {
        "eye.host=arm_pc": "`eye` runs in the container `box`: set `containers.box.host`",
        "mind.host=arm_pcc": "`host` takes a host; did you mean `arm_pc`?, not `arm_pcc`",
        "mind.host.x=pc": "`host.x` takes a value of its own, without a part below it, not `pc`",
        "pc.host=pc": "no node or container is called `pc`",
    }.items():
        with pytest.raises(OverrideError) as caught:
            moved(override)
        assert str(caught.value).startswith(words)


def test_a_node_leaves_its_container_and_stays_on_its_host() -> None:
    alone = changed("eye.container=none", "eye.threads=2").nodes["eye"]
    assert (alone.container, alone.host, alone.threads) == (None, "pc", 2)
    joined = changed("mind.container=box").nodes["mind"]
    assert (joined.container, joined.host) == ("box", "pc")
    with pytest.raises(OverrideError) as caught:
        changed("mind.container=boxx")
    assert str(caught.value) == (
        "`container` takes a container, or `none` for a process of its own; did you mean `box`?, not `boxx`"
    )


def test_inputs_that_fire_an_element_take_the_place_of_its_clock() -> None:
    text = TEXT.replace("timing: {core: 1,", "timing: {rate: 5 Hz, behaviour: periodic, core: 1,")
    for words in ("[image]", "[mind.image]", "[g.mind.image]"):
        (timing,) = apply_overrides(architecture(text), (f"mind.timing.trigger={words}",)).nodes["mind"].timing.values()
        assert timing.trigger == Trigger("any", ("g.mind.image",))
        assert (timing.rate, timing.period, timing.behaviour) == (None, None, "event")
    for words in ("[told]", "[mine.image]", "[image, told]"):
        with pytest.raises(OverrideError) as caught:
            apply_overrides(architecture(text), (f"mind.timing.trigger={words}",))
        assert str(caught.value).startswith(f"`mind` has no input `{words.strip('[]')}`")


def test_orders_are_those_of_processes_hosts_cores_and_resources() -> None:
    found = changed("box.scheduling=ros2_executor", "gpu.scheduling=fifo", "mind.scheduling=fifo")
    assert (found.containers["box"].scheduling, found.resources["gpu"].scheduling) == ("ros2_executor", "fifo")
    assert found.nodes["mind"].scheduling == "fifo"
    host = changed("pc.scheduling=edf", "pc.scheduling.2=round_robin", "pc.cores=2").hosts["pc"]
    assert (host.scheduling, host.core_scheduling, host.cores) == ("edf", {1: "fifo", 2: "round_robin"}, 2)


def test_a_component_leaves_its_callback_group_for_another() -> None:
    moved = changed("hands.callback_groups.quick=[fast, g.slow]").nodes["hands"]
    assert moved.callback_groups == {"quick": ("g.fast", "g.slow")}
    apart = changed("hands.callback_groups.third=slow").nodes["hands"]
    assert apart.callback_groups == {"quick": ("g.fast",), "third": ("g.slow",)}


def test_reentrant_and_callback_groups_replace_one_another() -> None:
    free = changed("hands.reentrant=true").nodes["hands"]
    assert (free.reentrant, free.callback_groups) == (True, {})
    back = changed("hands.reentrant=true", "hands.callback_groups.a=fast").nodes["hands"]
    assert (back.reentrant, back.callback_groups) == (False, {"a": ("g.fast",)})
    assert len(changed("hands.reentrant=false").nodes["hands"].callback_groups) == 2


def test_a_core_and_a_set_of_cores_replace_one_another() -> None:
    assert (timing_of("eye", "core=1").core, timing_of("eye", "core=1").cores) == (1, None)
    assert (timing_of("mind", "cores=[3, 2, 3]").core, timing_of("mind", "cores=3,2").cores) == (None, (2, 3))


def test_parts_of_timing_are_set_one_by_one() -> None:
    use = timing_of("eye", "uses.gpu=9 ms").uses["gpu"]
    assert (str(use.max), str(use.min)) == ("9 ms", "2 ms")
    assert str(timing_of("eye", "uses.gpu.min=3 ms").uses["gpu"].min) == "3 ms"
    assert str(timing_of("mind", "uses.gpu=1 ms").uses["gpu"].max) == "1 ms"
    stored = timing_of("mind", "inputs.image.wcet=8 ms", "inputs.timing.wcet=2 ms").inputs
    assert {name: (str(each.wcet), str(each.bcet)) for name, each in stored.items()} == {
        "g.mind.image": ("8 ms", "1 ms"),
        "g.mind.timing": ("2 ms", "None"),
    }
    assert (str(timing_of("mind", "deadline=8 ms").deadline), timing_of("mind", "dropped=kept").dropped) == (
        "8 ms",
        "kept",
    )


def test_another_execution_time_is_not_what_was_measured() -> None:
    assert timing_of("eye", "priority=3").measured_times is not None
    assert timing_of("eye", "wcet=0.5 ms").measured_times is None


def test_an_input_of_a_node_of_several_components_concerns_those_that_have_it() -> None:
    timing = changed("hands.timing.inputs.fast.told.wcet=1 ms").nodes["hands"].timing
    assert {component: list(each.inputs) for component, each in timing.items()} == {"g.fast": ["g.fast.told"]}
    timing = changed("hands.timing.inputs.told.wcet=1 ms").nodes["hands"].timing
    assert list(timing) == ["g.fast", "g.slow"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("bix.threads=2", "no node or container is called `bix`; did you mean `box`?"),
        ("gpv.scheduling=fifo", "no node, container, host or resource is called `gpv`; did you mean `gpu`?"),
        ("twin.threads=2", "`twin.threads` can mean `nodes.twin.threads` or `containers.twin.threads`"),
        ("eye.threads=2", "`eye` runs in the container `box`: set `containers.box.threads`"),
        ("box.threads=0", "`threads` takes a whole number from 1, not `0`"),
        ("box.threads.x=2", "`threads.x` takes a value of its own, without a part below it, not `2`"),
        ("box.reentrant=true", "no node is called `box`"),
        ("mind.reentrant=yes", "`reentrant` takes true or false, not `yes`"),
        (
            "box.scheduling=fixed_priority",
            "`scheduling` takes ros2_executor, fifo, non_preemptive, round_robin, edf, not `fixed_priority`",
        ),
        (
            "pc.scheduling.x=fifo",
            "`scheduling.x` takes fair, fixed_priority, non_preemptive, fifo, round_robin, edf, by host or by the number of a core, not `fifo`",
        ),
        ("gpu.scheduling=edf", "`scheduling` takes fifo, fixed_priority, not `edf`"),
        (
            "hands.callback_groups.a=mind",
            "`callback_groups.a` takes components of `hands`, as in callback_groups.GROUP=g.fast, not `mind`",
        ),
        (
            "hands.callback_groups=fast",
            "`callback_groups` takes components of `hands`, as in callback_groups.GROUP=g.fast, not `fast`",
        ),
        ("eye.timing.uses.gpv=1 ms", "no resource is called `gpv`; did you mean `gpu`?"),
        ("mind.timing.uses.gpu.min=1 ms", "`mind` does not use `gpu`: set `uses.gpu` first"),
        ("mind.timing.inputs.imag.wcet=1 ms", "`mind` has no input `imag`; did you mean `image`?"),
        ("mind.timing.cores=1,x", "`cores` takes whole numbers, such as 2, 3, not `1,x`"),
        ("mind.timing.cores=[]", "`cores` takes whole numbers, such as 2, 3, not `[]`"),
        ("mind.timing.dropped=lost", "`dropped` takes kept, forgotten, not `lost`"),
        ("mind.timing.deadline=0 ms", "mind: `deadline` cannot be zero"),
        (
            "mind.timing.inputs.image.bcet=4 ms",
            "mind: the shortest time of `inputs.g.mind.image` (4 ms) is above the longest (3 ms)",
        ),
        ("eye.timing.uses.gpu=1 ms", "eye: the shortest time of `uses.gpu` (2 ms) is above the longest (1 ms)"),
    ],
)
def test_what_cannot_be_set_is_refused_with_what_can(text: str, message: str) -> None:
    with pytest.raises(OverrideError) as caught:
        changed(text)
    assert str(caught.value) == message

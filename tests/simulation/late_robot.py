"""A robot whose planner keeps a thread from what is quicker: the chain is late, and the run shows why."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.simulation.chain_witnesses import find_publish_pauses, find_witnesses
from archgen.simulation.schedule_log import LateSchedule, record_schedule
from archgen.timing.analysis import Analysis, ChainResult, LateRun
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.random_systems import architecture

ROBOT = """hosts: {pc: {cores: 2}}
resources: {gpu: {host: pc, scheduling: fifo}}
containers: {box: {host: pc, threads: 1}}
groups:
  g:
    components:
      lidar: {outputs: {scan: T}}
      costmap: {inputs: {scan: lidar.scan}, outputs: {costs: T}}
      planner: {outputs: {way: {type: T, external: nobody}}}
      detector: {inputs: {costs: costmap.costs}, outputs: {stop: {type: T, external: motors}}}
      other: {outputs: {seen: {type: T, external: nobody}}}
nodes:
  lidar: {implements: lidar, host: pc, timing: {period: 100 ms, wcet: 2 ms, bcet: 2 ms}}
  costmap: {implements: costmap, container: box, timing: {period: 100 ms, wcet: 10 ms, bcet: 10 ms}}
  planner: {implements: planner, container: box, timing: {period: 400 ms, wcet: 150 ms, bcet: 150 ms}}
  detector: {implements: detector, host: pc, timing: {behaviour: event, wcet: 5 ms, bcet: 5 ms, uses: {gpu: 10 ms}}}
  other: {implements: other, host: pc, timing: {period: 50 ms, wcet: 1 ms, bcet: 1 ms, uses: {gpu: 20 ms}}}
chains: {stop: {through: [lidar, costmap, detector], deadline: 250 ms}}
"""


def analyse(text: str = ROBOT) -> tuple[Architecture, Analysis, dict[str, ChainResult]]:
    """Analyse a project with its chains."""
    model = architecture(text)
    analysis = analyse_architecture(model)
    return model, analysis, bound_all_chains(analysis, model)


def record_witnesses(text: str = ROBOT) -> dict[str, tuple[LateRun, LateSchedule]]:
    """Find the witnesses of a project's late chains, and what happened in them."""
    _, analysis, results = analyse(text)
    found = {}
    for key, witness in find_witnesses(analysis, results.values()).items():
        pauses = find_publish_pauses(analysis)
        schedule = record_schedule(analysis.system, results[key].through, witness.seed, witness.seconds, pauses)
        assert schedule is not None
        found[key] = witness, schedule
    return found

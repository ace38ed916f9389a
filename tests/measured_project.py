"""The project that recordings of tests are of."""

PROJECT = """\
archgen: 1
project: {id: p, title: P}
groups:
  g:
    components:
      scanner: {outputs: {scan: T}, timing: {period: 50 ms, wcet: 5 ms}}
      planner: {inputs: {scan: scanner.scan, map: mapper.map}, outputs: {path: T}}
      base: {inputs: {path: planner.path}, timing: {period: 20 ms, wcet: 2 ms}}
      mapper: {inputs: {scan: scanner.scan}, outputs: {map: T}, timing: {period: 1 s, wcet: 90 ms}}
      checker: {outputs: {state: T}, timing: {period: 100 ms}}
nodes:
  scan: {implements: scanner, namespace: /front, publishes: {scan: {topic: /scan, message: a_msgs/msg/T}}}
  plan:
    implements: planner
    publishes: {path: {topic: /path, message: a_msgs/msg/T}}
    timing: {trigger: [scan], wcet: 20 ms}
  drive: {implements: base}
  maps: {implements: [mapper, checker], publishes: {map: {topic: /map, message: a_msgs/msg/T}}}
chains:
  avoid: {through: [scan, plan, drive], deadline: 90 ms}
"""

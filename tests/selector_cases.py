"""Selectors and what they mean, for both who evaluate them: `archgen.model`, and the page of the site's explorer."""

from __future__ import annotations

ROBOT = """
partners: {certh: , tum: }
requirements: {R-1: {title: Safe, tags: [law]}, R-2: , R-0: All, R-1a: {parent: R-0}, R-1b: {parent: [R-1a, R-1]}}
hosts: {pc: , board: {tags: [gpu], properties: {ram: 8 GB}}}
use_cases:
  UC-1: {actors: {user: }, steps: [{from: camera.image, to: detector}, {from: detector, to: planning.fusion, say: what it saw}]}
  UC-2: {steps: [{from: base, to: base}]}
  UC-3: Without steps
groups:
  sensing:
    owner: certh
    tags: [perception]
    properties: {sil: 1}
    components:
      camera:
        role: source
        inputs: {light: {external: Light, medium: physical}}
        outputs: {image: Colour image, info: T}
      lidar: {outputs: {scan: Laser scan}, requirements: [R-1], tags: [safety], properties: {sil: 2, mass: 0.5 kg, due: 2027-03-01}}
  planning:
    owner: tum
    components:
      detector: {inputs: {image: camera.image}, outputs: {objects: T}, requirements: [R-1b], timing: {behaviour: event}, properties: {sil: none}}
      fusion: {inputs: {any_of: [lidar, detector, camera.info]}, outputs: {world: T}}
      solver: {inputs: {world: fusion}, outputs: {solve: std_srvs/srv/Trigger}}
      executor: {inputs: {ask: solver.solve}, outputs: {command: T}, requirements: [R-2, "R-2 in the dark"]}
  driving:
    components:
      base: {role: sink, parameters: {speed.max: 1.5}, properties: {mass: 12 kg, vendor: Acme Ltd, hot: 12 g}, inputs: {command: executor.command, stop: lidar}, outputs: {log: {type: T, deprecated: {until: 2999-03-01}}}}
      camera: {title: Rear Camera}
      odd: {inputs: {x: stub}}
      stub: {title: Stub, status: existing}
nodes:
  cam: {implements: sensing.camera, package: usb_cam, host: board, status: existing, parameters: {image: {fps: 30}}}
  eyes: {implements: [detector, fusion], package: our_vision, host: pc, tags: [certified], owner: certh, publishes: {world: }}
  eyes_too: {implements: fusion, subscribes: {any_of: }}
  relay: {package: topic_tools}
"""

FINDINGS = {"unread-output": frozenset({"driving.base", "eyes"})}
"""The elements that a rule found something about."""

SELECTED: tuple[tuple[str, str], ...] = (
    ("sensing", "camera lidar"),
    ("sensing.camera", "camera"),
    ("lidar", "lidar"),
    ("camera.image", "camera"),
    ("fusion.any_of", "fusion"),  # an input
    ("relay", ""),  # a node without component
    ("cam", "camera"),  # a node's component
    ("lidar solver", "lidar solver"),
    ("sensing -lidar", "camera"),
    ("-sensing -driving", "detector fusion solver executor"),
    ("-tag:safety sensing", "camera"),
    ("+fusion", "camera lidar detector fusion"),
    ("1+fusion", "camera lidar detector fusion"),
    ("1+solver", "fusion solver executor"),
    ("2+solver+0", "camera lidar detector fusion solver executor"),
    ("lidar+1", "lidar fusion d.base"),
    ("lidar+", "lidar fusion solver executor d.base"),
    ("1+detector+1", "camera detector fusion"),
    ("camera.image+1", "camera detector"),  # only what this output feeds
    ("executor+1", "solver executor d.base"),  # a service carries data both ways
    ("driving.stub+", "d.odd d.stub"),  # of which nobody knows yet what it sends
    ("camera.image..fusion", "camera detector fusion"),
    ("lidar..base", "lidar fusion solver executor d.base"),
    ("detector..tag:perception", ""),
    ("-camera.image..fusion", "lidar solver executor d.base d.camera d.odd d.stub"),
    ("*.camera", "camera d.camera"),
    ("sensing.*", "camera lidar"),
    ("*s*", "camera lidar detector fusion solver d.base d.stub"),
    ("*.ima*", "camera"),
    ("tag:perception", "camera lidar"),
    ("tag:safety", "lidar"),
    ("tag:law", "lidar"),  # of a requirement
    ("tag:gpu", "camera"),  # of a host
    ("tag:certified", "detector fusion"),  # of a node
    ("owner:certh", "camera lidar"),
    ("status:existing", "camera d.stub"),  # by its node, and by itself
    ("status:existing+", "camera detector fusion solver executor d.base d.odd d.stub"),
    ("status:planned", "lidar solver executor d.base d.camera d.odd d.stub"),
    ('type:"Colour  image"', "camera detector"),
    ("type:sensor_msgs/msg/LaserScan", "lidar fusion d.base"),
    ("medium:physical", "camera"),
    ("role:sink", "d.base"),
    ("host:pc", "detector fusion"),
    ("package:usb_*", "camera"),
    ("requirement:R-2", "executor"),
    ("requirement:R-1", "lidar detector"),  # what is part of it, too
    ("requirement:R-0", "detector"),
    ("requirement:R-1*", "lidar detector"),
    ("behaviour:event", "detector fusion"),
    ("finding:unread-output", "detector fusion d.base"),
    ("node:eyes", "detector fusion"),
    ("parameter:speed.*", "d.base"),
    ("parameter:image.fps", "camera"),  # of a node
    ("node:eyes*", "detector fusion"),
    ("property:sil", "camera lidar detector"),  # the group's for what has none of its own
    ("property:sil>=2", "lidar"),
    ("property:sil<2", "camera"),
    ("property:sil=1.0", "camera"),
    ("property:sil=n*", "detector"),
    ('property:"mass > 0.1 kg"', "lidar d.base"),
    ('property:"mass<=0.5 kg"', "lidar"),
    ('property:"*<500 g"', "d.base"),  # only in the same unit
    ("property:due<2027-03-02", "lidar"),
    ('property:"vendor=Acme Ltd"', "d.base"),
    ("property:vendor=*", "d.base"),
    ('property:"ram>=8 GB"', "camera"),  # of a host
    ("deprecated:output", "d.base"),
    ("deprecated:*", "d.base"),
    ("use_case:UC-1", "camera detector fusion"),
    ("use_case:UC-*", "camera detector fusion d.base"),
    ("use_case:UC-1 -detector", "camera fusion"),
    ("use_case:UC-2", "d.base"),
    ("-property:sil sensing planning", "fusion solver executor"),
    ("+role:sink -sensing", "detector fusion solver executor d.base"),
    ("host:pc..base", "detector fusion solver executor d.base"),
)
"""Selectors, and the components that they select, by their names and in order; those of `driving` with `d.`."""

SELECTED_NODES: tuple[tuple[str, list[str]], ...] = (
    ("sensing.camera", ["cam"]),
    ("fusion", ["eyes", "eyes_too"]),  # a component's selection is also its nodes
    ("node:eyes", ["eyes"]),
    ("node:relay", ["relay"]),
    ("1+node:eyes", ["cam", "eyes"]),  # steps between nodes
    ("node:cam+1", ["cam", "eyes", "eyes_too"]),
    ("node:cam..node:solver", ["cam", "executor", "eyes", "solver"]),
    ("planning -node:eyes", ["executor", "solver"]),
    ("detector -fusion", ["eyes"]),  # still needed for the detector
    ("owner:certh", ["cam", "eyes", "lidar"]),
    ("driving -driving.camera", ["base", "odd", "stub"]),
)

WRONG: tuple[tuple[str, str], ...] = (
    ("", "0-0 the selector is empty"),
    ("lidar, base", "5-6 `,` is reserved; words are separated by blanks | None"),
    ("lidar camra", "6-11 nothing is called `camra` | did you mean `camera`?"),
    (
        "camera",
        (
            "0-6 `camera` can mean `sensing.camera` or `driving.camera`"
            " | write more of the path, such as `sensing.camera`"
        ),
    ),
    ("colour:x", "0-6 no key `colour` | keys are tag, owner, status, type, medium, role, host, package, "),
    ("lidar tga:safety", "6-9 no key `tga` | did you mean `tag:`?"),
    ('type:"Colour image', '0-18 the quote is not closed | write `type:"Point cloud"`'),
    ("lidar +", "6-7 a path or `key:value` is missing"),
    ("x..", "2-3 a path or `key:value` is missing"),
    ("..x", "0-3 a path or `key:value` is expected, not `..x`"),
    ("tag:", "0-4 `tag:` needs a value"),
    ("lidar+base", "6-10 `base` is more than a word can hold"),
    ("2+lidar..base", "7-13 `..base` is more than a word can hold"),
    ("99999999+lidar", "0-14 `99999999` steps are too many"),
)
"""Selectors with an error: its place, its message and its help, or the beginning of that."""

FOUND_NOTHING: tuple[tuple[str, str], ...] = (
    ("lidar tag:nothing", "6-17 nothing has `tag:nothing`"),
    ("lidar *_x", "6-9 nothing fits `*_x`"),
    ("lidar use_case:UC-3", "6-19 nothing has `use_case:UC-3`"),
    ("lidar property:sil=>2", "6-21 nothing has `property:sil=>2`"),
    ("lidar property:mass>=1", "6-22 nothing has `property:mass>=1`"),
    ("lidar property:vendor>=1", "6-24 nothing has `property:vendor>=1`"),
)
"""Selectors with a warning, all of which select the lidar."""

COMPOSED_ROBOT = """
types: {Touch: {message: std_msgs/msg/Bool, deprecated: {until: 2999-01-01}}}
component_types:
  motor: {deprecated: {use: arm}, inputs: {target: Target}, outputs: {state: State}}
  arm:
    inputs: {goal: Goal}
    outputs: {state: {from: joint.state}}
    components:
      planner: {inputs: {goal: self.goal}, outputs: {target: Target}}
      joint: {is: motor, inputs: {target: planner.target}}
      hand:
        inputs: {close: self.goal}
        outputs: {touch: Touch}
        components: {finger: {inputs: {close: self.close}, outputs: {felt: Touch}}}
groups:
  body:
    components:
      brain: {tags: [safety], inputs: {states: [left.state, right.state]}, outputs: {goal: Goal}}
      left: {is: arm, inputs: {goal: brain.goal}}
      right: {same_as: arm, inputs: {goal: brain.goal}}
"""
"""Components in components; what `touch` of a hand gives on is not designed yet."""

COMPOSED_FINDINGS = {"unfed-output": frozenset({"body.left.hand"}), "unread-output": frozenset({"body.right.state"})}

COMPOSED_SELECTED = (
    "left",
    "body.left",
    "left.**",
    "body.**",
    "left.hand.**",
    "left.hand",
    "hand",
    "*.hand",
    "left.*",
    "*",
    "left.state",
    "left.state+1",
    "left.goal",
    "left.hand.touch",
    "left.hand.touch+",
    "hand.touch",
    "left.**+1",
    "1+left.**",
    "left.**..right.**",
    "-left.** body",
    "lefd.**",
    "planner.**",
    "*.planner.**",
    ".**",
    "**",
    "is:arm",
    "is:motor",
    "is:*",
    "-is:arm",
    "1+is:motor+1",
    "deprecated:component_type",
    "deprecated:type",
    "deprecated:*+1",
    "finding:*",
    "finding:unfed-output",
    "tag:safety+1",
    "brain.goal+2",
    "left..right",
    "left.state..right.hand.finger",
    "left right.planner -left.hand",
    "left.joint.state",
    "*.state",
    "type:Touch",
    "lefft.planner",
)
"""Selectors on it whose meaning the terminal says."""

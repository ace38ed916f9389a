"""The rules about references, with their pages."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

UNKNOWN_REFERENCE = """A reference names nothing.

Why: A reference is the path of an element, whose leading parts may be left out: `group.component.output`, `component.output`
or `output`. Where no element of the kind that is asked for has a path that ends in these words, nothing is connected.

Bad:
    groups:
      sensing:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
          screen: {inputs: {image: camrea.image}}
          recorder: {inputs: {image: camera.image}}
    nodes:
      camera: {implements: camera}
      screen: {implements: screen}
      recorder: {implements: recorder}

Good:
    groups:
      sensing:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
          screen: {inputs: {image: camera.image}}
          recorder: {inputs: {image: camera.image}}
    nodes:
      camera: {implements: camera}
      screen: {implements: screen}
      recorder: {implements: recorder}
"""

AMBIGUOUS_REFERENCE = """A reference can mean several elements.

Why: Leading parts of a path may be left out only where one element can be meant. Elements of the writer's own group go before
those of others; among the rest archgen does not guess.

Bad:
    groups:
      head:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
      hand:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
      perception:
        components:
          detector: {inputs: {image: camera.image}}
          recorder: {inputs: {images: [head.camera.image, hand.camera.image]}}
    nodes:
      head_camera: {implements: head.camera}
      hand_camera: {implements: hand.camera}
      detector: {implements: detector}
      recorder: {implements: recorder}

Good:
    groups:
      head:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
      hand:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
      perception:
        components:
          detector: {inputs: {image: head.camera.image}}
          recorder: {inputs: {images: [head.camera.image, hand.camera.image]}}
    nodes:
      head_camera: {implements: head.camera}
      hand_camera: {implements: hand.camera}
      detector: {implements: detector}
      recorder: {implements: recorder}
"""

HIDDEN_REFERENCE = """A complete path hides another element that the same words may mean.

Why: A complete path is always that element: `speech` is the group of this name, even where a component is called `speech`, too.
Who meant the component gets all outputs of the group.

Bad:
    groups:
      speech:
        components:
          recogniser: {outputs: {words: std_msgs/msg/String}}
      interaction:
        components:
          speech: {outputs: {sentence: std_msgs/msg/String}}
          dialogue: {inputs: {heard: speech, said: interaction.speech}}
    nodes:
      recogniser: {implements: recogniser}
      speech_node: {implements: interaction.speech}
      dialogue: {implements: dialogue}

Good:
    groups:
      speech:
        components:
          recogniser: {outputs: {words: std_msgs/msg/String}}
      interaction:
        components:
          speech: {outputs: {sentence: std_msgs/msg/String}}
          dialogue: {inputs: {heard: recogniser, said: interaction.speech}}
    nodes:
      recogniser: {implements: recogniser}
      speech_node: {implements: interaction.speech}
      dialogue: {implements: dialogue}
"""

RULES = (
    Rule("unknown-reference", Severity.ERROR, UNKNOWN_REFERENCE, fixed=True),
    Rule("ambiguous-reference", Severity.ERROR, AMBIGUOUS_REFERENCE, fixed=True),
    Rule("hidden-reference", Severity.WARNING, HIDDEN_REFERENCE),
)

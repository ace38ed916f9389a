"""The rules of the stages up to linking, which have no function of their own: a line each."""

from archgen.diagnostics.diagnostic import Rule, Severity, read_rules

READING_RULES = read_rules("""
# About files by themselves, for syntax and schema alike.
fixed invalid-interface: A definition of a message, a service or an action that ROS would refuse.
fixed syntax-error: A file is not YAML, or not a text file.
fixed merge-conflict: A file holds the markers of a merge that Git could not finish.
fixed duplicate-key: One mapping has the same key twice.
fixed recursive-alias: An alias stands inside of the value that it stands for.
fixed too-large: A file is larger, deeper or, with its aliases expanded, longer than archgen reads.
fixed unknown-key: A key that the language does not have.
fixed missing-key: An element lacks the key without which it means nothing, in all files of the project.
fixed wrong-type: A value is of another kind than its key takes: text instead of a mapping, or instead of a number.
fixed wrong-value: A value that its key does not take: an unknown word, a quantity without its unit, an id that is none.
note swallowed-text: A comment right after plain text looks as if it were meant as a part of the text.
# About finding a project's files.
note ignored-file: A file below the project's folder that may be a part of it is not read.
fixed missing-library: A library that archgen.yaml names cannot be read.
warning missing-source: A pattern in `sources` or `ros.interfaces` matches no file.
error wrong-pass: A pass of the project, rules in a file of its folder `passes`, cannot be read or comes to no end.
""")
MERGING_RULES = read_rules("""
fixed conflicting-values: One value is written in two places of the project.
fixed undeclared-element: A file adds to a component or a group that no file declares.
""")
LINKING_RULES = (
    *read_rules("""
# About component types and their instances.
fixed unknown-port: An instance writes about a port that its type does not have.
fixed unknown-component: An instance writes about a component inside that its type does not have.
fixed changed-reference: A reference to a component type (`same_as`) writes what the type decides.
fixed circular-types: A component type is made from itself, or holds itself.
fixed abstract-type: A component is an instance of an abstract type.
fixed narrower-type: A type that stands in the place of another has fewer ports.
fixed too-many-elements: Instances inside of instances stand for more components than can be written out.
# About references.
fixed unknown-reference: A reference names nothing.
fixed ambiguous-reference: A reference can mean several elements.
warning hidden-reference: A complete path hides another element that the same words may mean.
# About components inside of components and what connects them.
fixed reaches-outside: Inside of a component type, a reference means something outside of it.
warning reaches-inside: A reference reaches past the ports of a composed component.
warning ambiguous-connection: `autoconnect` could join an input to several outputs.
warning several-sources: `from` of an instance gives one input several outputs.
note unused-node: What a component says of its own node is not used, since another node runs it.
fixed duplicate-port: A composed component has an output and a component inside with one id.
# About types with fields.
fixed unknown-field-type: A field has a type that nobody knows.
fixed circular-fields: A type holds itself by its fields.
fixed conflicting-message: A type with fields defines no message, or one that is defined elsewhere.
fixed unbound-generic: A generic type is used without the types that it is made for, or with a wrong number of them.
# About variants themselves.
fixed unknown-variant: A variant is built on one that the project does not have.
fixed circular-variant: Variants are built on one another in a circle.
error missing-variant-part: A variant drops a key that is not there, changes what it takes out, or names something and changes nothing of it.
warning empty-variant-selector: A word of a variant's `without` selects nothing.
# About what a project names: chapters, pictures, files, hints, programs.
fixed duplicate-frame: A frame is declared twice.
fixed missing-chapter: The report asks for a chapter that is neither one that archgen writes nor a file of the project.
warning missing-file: An element names a document or a picture that is not in the project.
off missing-parameter-file: A parameter file that a node names is not there.
warning missing-verification: What is to verify a requirement is not there.
error wrong-hint: A hint is not what the backend that it is for reads.
warning shadowed-package: A node is in a package that others publish, and nothing says that its program exists: code would be generated in its place.
warning unlike-program: A program has a name of its own for what it reads or sends, and the design another one, to which nothing remaps it.
"""),
    Rule(
        "missing-picture",
        Severity.WARNING,
        "A chapter of the report shows a picture that is not there.",
        # A chapter has no comments of YAML that could silence a line.
        setting="rules: {missing-picture: note}  # off, note, warning or error",
    ),
)

package archgen.runtime;

/** A port of a component. */
abstract class Port {
    final Component component;
    final String name;

    Port(Component component, String name) {
        this.component = component;
        this.name = name;
    }

    final String id() {
        return component.id() + "." + name;
    }
}

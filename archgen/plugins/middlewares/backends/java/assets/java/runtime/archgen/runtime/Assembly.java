package archgen.runtime;

import java.util.ArrayList;
import java.util.Comparator;
import java.util.HashMap;
import java.util.List;
import java.util.Map;

/** What holds components and joins their ports: a group, a composed component, the whole. */
public abstract class Assembly {
    private final List<Component> components = new ArrayList<>();

    /** Make an assembly without parts. */
    protected Assembly() {}

    /**
     * Add a component.
     *
     * @param <C> its class
     * @param component the component
     * @return the same
     */
    protected final <C extends Component> C add(C component) {
        components.add(component);
        return component;
    }

    /**
     * Add an assembly with all that it holds.
     *
     * @param <A> its class
     * @param assembly the assembly
     * @return the same
     */
    protected final <A extends Assembly> A include(A assembly) {
        components.addAll(((Assembly) assembly).components);
        return assembly;
    }

    /**
     * Let an input read an output.
     *
     * @param <T> the type of what is sent
     * @param output the output
     * @param input the input
     */
    protected static <T> void connect(OutPort<T> output, InPort<? super T> input) {
        output.addReader(input);
    }

    /**
     * Let a component call another one.
     *
     * @param <Q> the type of requests
     * @param <F> the type of what is told in between
     * @param <A> the type of answers
     * @param server what answers
     * @param client what calls
     */
    protected static <Q, F, A> void connect(Server<Q, F, A> server, Client<Q, F, A> client) {
        client.addServer(server);
    }

    /**
     * Return all components.
     *
     * @return in the order of the model
     */
    public final List<Component> components() {
        return List.copyOf(components);
    }

    /**
     * Return what is connected.
     *
     * @return {@code OUTPUT -> INPUT} for each connection, in the order of the outputs
     */
    public final List<String> listConnections() {
        sortReaders();
        List<String> connections = new ArrayList<>();
        for (Component component : components) {
            for (OutPort<?> output : component.outputs()) {
                output.readers().forEach(reader -> connections.add(output.id() + " -> " + reader.id()));
            }
        }
        for (Component component : components) {
            for (Client<?, ?, ?> client : component.clients()) {
                client.servers().forEach(server -> connections.add(server.id() + " -> " + client.id()));
            }
        }
        return connections;
    }

    /** Bring the readers of each output into the order of the model: what is sent arrives in it. */
    final void sortReaders() {
        Map<InPort<?>, Integer> ranks = new HashMap<>();
        components.forEach(component -> component.inputs().forEach(port -> ranks.put(port, ranks.size())));
        for (Component component : components) {
            component.outputs().forEach(output -> output.readers().sort(Comparator.comparing(ranks::get)));
        }
    }
}

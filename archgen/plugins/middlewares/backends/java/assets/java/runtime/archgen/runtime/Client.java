package archgen.runtime;

import java.util.ArrayList;
import java.util.List;
import java.util.function.Consumer;

/**
 * What a component calls: a service or an action. A call takes no time.
 *
 * @param <Q> the type of requests
 * @param <F> the type of what is told in between
 * @param <A> the type of answers
 */
public final class Client<Q, F, A> extends Port {
    private final List<Server<Q, F, A>> servers = new ArrayList<>();

    Client(Component component, String name) {
        super(component, name);
    }

    /**
     * Call, and leave what is told in between.
     *
     * @param request what is asked
     * @return the answer
     */
    public A call(Q request) {
        return call(request, told -> {});
    }

    /**
     * Call the server; of several the first in the model.
     *
     * @param request what is asked
     * @param feedback gets what is told in between
     * @return the answer
     */
    public A call(Q request, Consumer<F> feedback) {
        if (servers.isEmpty()) {
            throw new SimulationException(id() + " is connected to nothing that answers");
        }
        return component.simulation().call(this, servers.get(0), request, feedback);
    }

    void addServer(Server<Q, F, A> server) {
        servers.add(server);
    }

    List<Server<Q, F, A>> servers() {
        return servers;
    }
}

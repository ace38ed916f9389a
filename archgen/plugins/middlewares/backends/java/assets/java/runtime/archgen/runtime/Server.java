package archgen.runtime;

import java.util.function.BiFunction;
import java.util.function.Consumer;

/**
 * What others may call: a service or an action.
 *
 * @param <Q> the type of requests
 * @param <F> the type of what is told in between
 * @param <A> the type of answers
 */
public final class Server<Q, F, A> extends Port {
    private final BiFunction<Q, Consumer<F>, A> handler;

    Server(Component component, String name, BiFunction<Q, Consumer<F>, A> handler) {
        super(component, name);
        this.handler = handler;
    }

    A answer(Q request, Consumer<F> feedback) {
        return handler.apply(request, feedback);
    }
}

# archgen in a container, with what draws pictures: docs/releasing.md says how it is called and by whom it is built.
FROM python:3.13-slim-bookworm AS build
WORKDIR /source
COPY ci/locked/run.txt ci/locked/run.txt
# The versions and hashes that our own CI has; then archgen itself, which fetches nothing.
RUN python -m venv /opt/archgen \
    && /opt/archgen/bin/pip install --no-cache-dir --disable-pip-version-check --require-hashes -r ci/locked/run.txt
COPY . .
RUN /opt/archgen/bin/pip install --no-cache-dir --disable-pip-version-check --no-deps --no-build-isolation .

FROM python:3.13-slim-bookworm
# The versions of these are Debian's own, which mends them.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends git libglib2.0-0 libx11-6 libxext6 libxrender1 libexpat1 \
    && rm -rf /var/lib/apt/lists/* \
    && useradd --create-home --uid 1000 archgen
COPY --from=build /opt/archgen /opt/archgen
ENV PATH="/opt/archgen/bin:$PATH"
USER 1000
WORKDIR /project
ENTRYPOINT ["archgen"]
CMD ["check"]

# Debian 12 with drape in it, built for the processor of this machine:
#
#   docker build -t drape .
#   docker run --rm -v "$PWD/results:/drape/results" drape              make demo
#   docker run --rm drape make test
FROM debian:12 AS packages
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates git make && rm -rf /var/lib/apt/lists/*
WORKDIR /drape
# The packages first: a change of the sources does not install them again.
COPY third_party/setup third_party/packages-to-run.txt third_party/
RUN third_party/setup run && rm -rf /var/lib/apt/lists/*
# .devcontainer ends before this: it mounts the sources and builds them there.
FROM packages
COPY . .
RUN make
CMD ["make", "demo"]

# weftd, the meshing server, in a container:
#
#   docker build -t weft .
#   docker run --rm -p 127.0.0.1:7421:7421 -e WEFT_INSECURE=1 weft

FROM debian:bookworm-slim AS build
WORKDIR /src
COPY deploy/install-deps.sh deploy/
RUN deploy/install-deps.sh build
COPY . .
RUN cmake --preset release -DBUILD_TESTING=OFF \
 && cmake --build --preset release --target weftd weft \
 && strip build/release/weftd build/release/weft

FROM debian:bookworm-slim
COPY deploy/install-deps.sh /tmp/
RUN /tmp/install-deps.sh runtime \
 && rm -rf /tmp/install-deps.sh /var/lib/apt/lists/* \
 && useradd --system --no-create-home --shell /usr/sbin/nologin weft
COPY --from=build /src/LICENSE /usr/share/doc/weft/
COPY --from=build /src/LICENSES /usr/share/doc/weft/LICENSES
COPY --from=build /src/build/release/weftd /src/build/release/weft /usr/local/bin/
USER weft
# Each of weftd's flags has such a variable.
ENV WEFT_LISTEN=0.0.0.0:7421,unix:/tmp/weftd
EXPOSE 7421
# Over the socket, which needs neither certificates nor tokens.
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s \
  CMD ["weft", "health", "--server", "unix:/tmp/weftd"]
ENTRYPOINT ["weftd"]

# weftd, the meshing server, in a container:
#
#   docker build -t weft .
#   docker run --rm --read-only -p 127.0.0.1:7421:7421 -e WEFT_INSECURE=1 -v weft:/var/lib/weft weft
#
# BASE is Debian 12 with nothing on top; tests/container.sh makes its own and pulls none.
ARG BASE=debian:bookworm-slim

FROM ${BASE} AS build
WORKDIR /src
COPY deploy/install-deps.sh deploy/
RUN deploy/install-deps.sh build console
COPY . .
ARG WERROR=OFF
# AUTO: without the console's pages if npm can get no packages; ON: fail; OFF: always without them.
ARG CONSOLE=AUTO
RUN export CCACHE_DIR=/var/cache/ccache \
 && cmake --preset release -DBUILD_TESTING=OFF -DWEFT_GDAL=OFF -DWEFT_PROJ=OFF -DWEFT_WERROR=${WERROR} \
      -DWEFT_CONSOLE=${CONSOLE} \
 && cmake --build --preset release --target weftd weft \
 && strip build/release/weftd build/release/weft

FROM ${BASE}
LABEL org.opencontainers.image.title="weft" \
      org.opencontainers.image.description="Graded, guaranteed-quality Delaunay meshes over gRPC" \
      org.opencontainers.image.licenses="Apache-2.0"
COPY deploy/install-deps.sh /tmp/
# Nothing here reads what is left out: documentation and translations, all fonts but the one of the
# drawings, and libraries beside those that the programs load, such as protobuf's compiler.
RUN printf 'path-exclude=%s\n' '/usr/share/doc/*' '/usr/share/man/*' '/usr/share/info/*' \
      '/usr/share/locale/*' '/usr/share/lintian/*' '/usr/share/X11/*' '/usr/share/fonts/*.ttf' \
      '*/libprotoc.so*' '*/libsleefgnuabi.so*' '*/libbrotlienc.so*' \
      >/etc/dpkg/dpkg.cfg.d/small \
 && echo 'path-include=*/DejaVuSans.ttf' >>/etc/dpkg/dpkg.cfg.d/small \
 && /tmp/install-deps.sh runtime \
 && rm -rf /tmp/install-deps.sh /var/lib/apt/lists/* /var/cache/apt/* /var/cache/debconf/*-old \
      /var/lib/dpkg/*-old /var/log/* \
 && useradd --system --no-create-home --shell /usr/sbin/nologin --uid 990 weft \
 && install -d -o weft -g weft -m 700 /var/lib/weft
COPY --from=build /src/LICENSE /src/NOTICE /src/LICENSES/ /usr/share/doc/weft/
COPY --from=build /src/build/release/weftd /src/build/release/weft /usr/local/bin/
USER 990
VOLUME /var/lib/weft
# Each of weftd's flags has such a variable. Nothing is written but in the volume: the root file
# system may be read-only.
ENV WEFT_LISTEN=0.0.0.0:7421,unix:/var/lib/weft/socket \
    WEFT_METRICS=0.0.0.0:9421 \
    WEFT_DATA=/var/lib/weft
EXPOSE 7421 9421
# Over the socket, which needs neither certificates nor tokens.
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s \
  CMD ["weft", "health", "--server", "unix:/var/lib/weft/socket"]
STOPSIGNAL SIGTERM
ENTRYPOINT ["weftd"]

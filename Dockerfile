# weft in containers, by two targets:
#
#   docker build -t weftd .                    the server alone; the last target, so the default
#   docker build -t weft --target weft .       the command line, with weftd beside it
#
#   docker run --rm --read-only -p 127.0.0.1:7421:7421 -e WEFT_INSECURE=1 -v weft:/var/lib/weft weftd
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" weft mesh key.poly -o key.vtu
#
# BASE is Debian 12 with nothing on top; deploy/image.sh makes its own and pulls none. PROGRAMS is the
# stage, or the image, that holds the programs; image.sh builds it once for both targets.
ARG BASE=debian:bookworm-slim
ARG PROGRAMS=programs

FROM ${BASE} AS build
WORKDIR /src
COPY deploy/install-deps.sh deploy/
RUN deploy/install-deps.sh build console geo
COPY . .
ARG WERROR=OFF
# AUTO: without the console's pages if npm can get no packages; ON: fail; OFF: always without them.
ARG CONSOLE=AUTO
# A file of authorities that npm trusts besides its own.
ARG NODE_EXTRA_CA_CERTS
RUN export CCACHE_DIR=/var/cache/ccache \
 && cmake --preset release -DBUILD_TESTING=OFF -DWEFT_GDAL=ON -DWEFT_PROJ=ON -DWEFT_METIS=ON \
      -DWEFT_WERROR=${WERROR} -DWEFT_CONSOLE=${CONSOLE} \
 && cmake --build --preset release --target weftd weft \
 && strip build/release/weftd build/release/weft

FROM scratch AS programs
COPY --from=build /src/LICENSE /src/NOTICE /src/LICENSES/ /licences/
COPY --from=build /src/build/release/weftd /src/build/release/weft /

FROM ${PROGRAMS} AS made

# What both targets have: weftd and what it loads.
FROM ${BASE} AS runtime
LABEL org.opencontainers.image.licenses="Apache-2.0"
COPY deploy/install-deps.sh /tmp/
# Nothing here reads what is left out: documentation and translations, all fonts but the one of the
# drawings, and libraries beside those that the programs load, such as protobuf's compiler.
RUN printf 'path-exclude=%s\n' '/usr/share/doc/*' '/usr/share/man/*' '/usr/share/info/*' \
      '/usr/share/locale/*' '/usr/share/lintian/*' '/usr/share/X11/*' '/usr/share/fonts/*.ttf' \
      '*/libprotoc.so*' '*/libsleefgnuabi.so*' '*/libbrotlienc.so*' \
      >/etc/dpkg/dpkg.cfg.d/small \
 && echo 'path-include=*/DejaVuSans.ttf' >>/etc/dpkg/dpkg.cfg.d/small \
 && /tmp/install-deps.sh weftd \
 && rm -rf /tmp/install-deps.sh /var/lib/apt/lists/* /var/cache/apt/* /var/cache/debconf/*-old \
      /var/lib/dpkg/*-old /var/log/* \
 && useradd --system --no-create-home --shell /usr/sbin/nologin --uid 990 weft
COPY --from=made /licences/ /usr/share/doc/weft/
COPY --from=made /weftd /usr/local/bin/

# weft starts a server of its own unless WEFT_SERVER names one.
FROM runtime AS weft
LABEL org.opencontainers.image.title="weft" \
      org.opencontainers.image.description="Makes and judges graded, guaranteed-quality Delaunay meshes"
COPY deploy/install-deps.sh /tmp/
RUN /tmp/install-deps.sh weft \
 && rm -rf /tmp/install-deps.sh /var/lib/apt/lists/* /var/cache/apt/* /var/cache/debconf/*-old \
      /var/lib/dpkg/*-old /var/log/*
COPY --from=made /weft /usr/local/bin/
# Fonts are listed there for drawings; whoever runs the image has no home in it.
ENV XDG_CACHE_HOME=/tmp
USER 990
WORKDIR /work
ENTRYPOINT ["weft"]

FROM runtime AS weftd
LABEL org.opencontainers.image.title="weftd" \
      org.opencontainers.image.description="Graded, guaranteed-quality Delaunay meshes over gRPC"
RUN install -d -o weft -g weft -m 700 /var/lib/weft
USER 990
VOLUME /var/lib/weft
# Each of weftd's flags has such a variable. Nothing is written but in the volume: the root file
# system may be read-only.
ENV WEFT_LISTEN=0.0.0.0:7421,unix:/var/lib/weft/socket \
    WEFT_METRICS=0.0.0.0:9421 \
    WEFT_DATA=/var/lib/weft \
    TMPDIR=/var/lib/weft
EXPOSE 7421 9421
# Over the socket in WEFT_LISTEN, which needs neither certificates nor tokens.
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s CMD ["weftd", "--health"]
STOPSIGNAL SIGTERM
ENTRYPOINT ["weftd"]

# docker build -t edmill . && docker run --rm -v "$PWD:/work" edmill run case.toml
ARG DEBIAN=12
FROM debian:$DEBIAN AS build
COPY . /edmill
RUN cd /edmill && ./bootstrap.sh build && apt-get install -y -qq --no-install-recommends dpkg-dev file && \
    cd build/release && cpack -D CPACK_COMPONENTS_ALL=program -B /package

FROM debian:$DEBIAN
COPY --from=build /package/*.deb /tmp/
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends /tmp/*.deb && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["edmill"]

# docker build -t edmill . && docker run --rm -v "$PWD:/work" edmill run case.toml
FROM debian:12 AS build
COPY . /edmill
RUN cd /edmill && ./bootstrap.sh build

FROM debian:12
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends libflint-arb2 libfmt9 libhdf5-103-1 libmpfr6 libopenmpi3 libpugixml1v5 \
      libquadmath0 libtbb12 libtomlplusplus3 libzstd1 zlib1g && rm -rf /var/lib/apt/lists/*
COPY --from=build /edmill/build/release/edmill /usr/bin/edmill
WORKDIR /work
ENTRYPOINT ["edmill"]

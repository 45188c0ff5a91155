# The same set-up as on a Debian machine:  docker build -t gears . && docker run --rm -v "$PWD:/scenes" gears run lundvall2004.toml
FROM debian:trixie-slim
COPY . /opt/fenics_gears
RUN /opt/fenics_gears/gears --set-up-only \
    && apt-get clean && rm -rf /var/lib/apt/lists/*
# mpirun as root, for studies: docker run --entrypoint mpirun gears -n 4 gears study STUDY
ENV OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
RUN ln -sf /opt/fenics_gears/gears /usr/local/bin/gears
WORKDIR /scenes
ENTRYPOINT ["gears"]

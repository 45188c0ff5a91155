# The same set-up as on a Debian machine:
#   docker build -t gears .
#   cd demos && docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/scenes" -v gears-cache:/cache gears run lundvall2004.toml
# The results are in demos/results and belong to you; the volume gears-cache keeps condensed gears for the next run.
FROM debian:trixie-slim
# What is installed depends on these files alone, so a change of the sources installs nothing again.
COPY gears /opt/fenics_gears/gears
COPY setup /opt/fenics_gears/setup
RUN /opt/fenics_gears/gears --set-up-only \
    && apt-get clean && rm -rf /var/lib/apt/lists/*
COPY . /opt/fenics_gears
RUN /opt/fenics_gears/gears --set-up-only
RUN ln -sf /opt/fenics_gears/gears /usr/local/bin/gears \
    && useradd --create-home gears && install -d -m 1777 /cache /scenes
# Condensed gears and compiled code. Anybody may make folders there, but each belongs to the user who made it: another
# user of the same volume works without keeping what it compiles and condenses, or takes a volume of its own.
ENV XDG_CACHE_HOME=/cache HOME=/cache
# mpirun as root, for studies: docker run --user root --entrypoint mpirun gears -n 4 gears study STUDY
ENV OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
VOLUME /cache
USER gears
WORKDIR /scenes
ENTRYPOINT ["gears"]

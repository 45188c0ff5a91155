"""A Debian system in a folder, entered as a container would be."""

import os
import shlex
import shutil
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

# What the slim images of Docker leave out.
LEFT_OUT = ("doc", "groff", "info", "lintian", "linda", "locale", "man")
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
# Behind a proxy these tell apt and pip the way; elsewhere they are not set.
HANDED_ON = ("http_proxy", "https_proxy", "no_proxy", "HTTP_PROXY", "HTTPS_PROXY", "NO_PROXY")
CERTIFICATES = "/etc/certificates-of-the-host.pem"
# Docker gives 64 MiB of shared memory, which browsers and MPI feel. Mounts and processes end with the call, however it
# ends.
ENTER = """
mount -t proc proc "$root/proc" && mount -t sysfs -o ro sysfs "$root/sys" && mount --bind /dev "$root/dev" &&
mount --bind /dev/pts "$root/dev/pts" && mount -t tmpfs -o size=64m,mode=1777 shm "$root/dev/shm" || exit 125
chroot "$root" /bin/sh -c 'cd "$1" && shift && exec "$@"' sh "$folder" "$@"
exit $?
"""


@dataclass(frozen=True)
class Call:
    exit_code: int
    seconds: float
    output: str

    @property
    def is_green(self) -> bool:
        return self.exit_code == 0


@dataclass(frozen=True)
class Root:
    """The system of a suite ("trixie") in a folder."""

    suite: str
    folder: Path

    def is_there(self) -> bool:
        return (self.folder / "etc/apt/sources.list").exists()

    def make(self, log: Path, expired=False) -> Call:
        """Make it anew, as small as Docker's slim images; expired: take package lists past their date."""
        self.remove()
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        as_docker = ["--dpkgopt=force-unsafe-io", '--aptopt=Acquire::Languages "none"']
        as_docker += [f"--dpkgopt=path-exclude=/usr/share/{name}/*" for name in LEFT_OUT]
        if expired:
            as_docker.append('--aptopt=Acquire::Check-Valid-Until "false"')
        aside = self.folder.with_name(f"{self.folder.name}.part")
        _remove(aside)
        call = _run(["mmdebstrap", "--variant=minbase", *as_docker, self.suite, aside], log)
        if call.is_green:
            aside.rename(self.folder)
        return call

    def remove(self) -> None:
        _remove(self.folder)

    def copy_in(self, archive: bytes, folder: str) -> None:
        subprocess.run(["tar", "-x", "-C", self.empty_folder(folder)], input=archive, check=True)

    def empty_folder(self, folder: str) -> Path:
        """Make a folder in it anew, and return its path from outside."""
        target = self.folder / folder.lstrip("/")
        _remove(target)
        target.mkdir(parents=True)
        return target

    def call(self, command: list[str], log: Path, folder="/", environment=None) -> Call:
        outside = {name: os.environ[name] for name in HANDED_ON if name in os.environ}
        shutil.copy("/etc/resolv.conf", self.folder / "etc/resolv.conf")
        certificates = next((os.environ[name] for name in ("PIP_CERT", "SSL_CERT_FILE") if name in os.environ), None)
        if certificates:
            shutil.copy(certificates, self.folder / CERTIFICATES.lstrip("/"))
            outside["PIP_CERT"] = CERTIFICATES
        enter = f"root={shlex.quote(str(self.folder))} folder={shlex.quote(folder)}\n{ENTER}"
        isolated = ["unshare", "--mount", "--pid", "--ipc", "--fork", "--kill-child", "/bin/sh", "-c", enter, "sh"]
        inside = {"PATH": PATH, "HOME": "/root", "HOSTNAME": self.suite, **outside, **(environment or {})}
        return _run([*isolated, *command], log, env=inside)


def _run(command, log, **options) -> Call:
    began = time.monotonic()
    with open(log, "w", encoding="utf-8") as file:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, **options)
    return Call(done.returncode, time.monotonic() - began, log.read_text(encoding="utf-8", errors="replace"))


def _remove(folder: Path) -> None:
    if folder.exists():
        subprocess.run(["rm", "-rf", "--one-file-system", folder], check=True)

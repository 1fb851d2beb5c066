#!/bin/sh
# A sweep of 64 points as an array of 4 by a real Slurm gives the file of one machine, byte for
# byte. Slurm runs in a bare Debian of its own, in namespaces of its own, so that nothing stays but
# that folder.
# Usage: slurm.sh DVI      exit code 77 where this is impossible: without root, debootstrap,
#                          namespaces, or a mirror of Debian. DVI_SLURM_HOME keeps the bare Debian
#                          between runs (default: a folder under the temporary directory).
set -eu
skip() { echo "skipped: $*"; exit 77; }
here=$(cd "$(dirname "$0")" && pwd)

# ---- in the namespaces: slurm.sh --inside BASE DVI ----

# Configure a controller and a node with 2 cores (4 tasks wait for each other), without cgroups.
configure() {
  cat >"$base/etc/slurm/slurm.conf" <<END
ClusterName=bare
SlurmctldHost=bare
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
StateSaveLocation=/var/spool/slurmctld
SlurmdSpoolDir=/var/spool/slurmd
SlurmctldPidFile=/run/slurmctld.pid
SlurmdPidFile=/run/slurmd.pid
SlurmctldLogFile=/var/log/slurmctld.log
SlurmdLogFile=/var/log/slurmd.log
SchedulerParameters=sched_interval=1
NodeName=bare CPUs=2 RealMemory=100 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
  echo CgroupPlugin=cgroup/v1 >"$base/etc/slurm/cgroup.conf"
  echo 127.0.0.1 localhost bare >"$base/etc/hosts"
  cat >"$base/root/sweep.sh" <<'END'
#!/bin/sh
#SBATCH --array=1-4
#SBATCH --cpus-per-task=1
dvi sweep cart.yaml --set l=0.2:1:64 --set m=0.2 --t-end 10 --threads 1 --part slurm --out l.csv
END
}

# The daemons, the array, and a join that waits for it.
jobs_script() {
  cat <<'END'
set -eu
cd /root
mkdir -p /run/munge /var/spool/slurmctld /var/spool/slurmd /var/log/munge
chown munge:munge /run/munge /var/log/munge
[ -s /etc/munge/munge.key ] || head -c 1024 /dev/urandom >/etc/munge/munge.key
chown munge:munge /etc/munge/munge.key
chmod 400 /etc/munge/munge.key
setpriv --reuid munge --regid munge --clear-groups munged
slurmctld
slurmd
for _ in $(seq 60); do
  sinfo -h -o %T 2>/dev/null | grep -q idle && break
  sleep 0.5
done
sinfo
rm -f *.csv* slurm-*.out
dvi init cart.yaml 2>/dev/null || [ -e cart.yaml ]
grid="cart.yaml --set l=0.2:1:64 --set m=0.2 --t-end 10"
dvi sweep $grid --out l.csv
mv l.csv whole.csv
# Ids need not begin at 1.
for ids in 1-4 3-10:2; do
  rm -f l.csv*
  array=$(sbatch --parsable --array=$ids sweep.sh)
  sbatch --wait --dependency=afterany:"$array" \
    --wrap "dvi sweep $grid --out l.csv --join l.csv.*-of-4"
  cat slurm-*.out
  ls -l l.csv*
  cmp l.csv whole.csv
done
echo "$(($(wc -l <l.csv) - 1)) points by an array of $(ls l.csv.*-of-4 | wc -l): the same bytes"
END
}

# Put the binary and the libraries that a bare Debian does not have where it finds them.
install_dvi() {
  mkdir -p "$base/opt/dvi"
  cp -L "$dvi" "$base/opt/dvi/dvi.bin"
  for library in $(ldd "$dvi" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }'); do
    case ${library##*/} in
    libc.so* | libm.so* | libpthread.so* | libdl.so* | librt.so*) ;;
    *) cp -L "$library" "$base/opt/dvi/" ;;
    esac
  done
  printf '#!/bin/sh\nLD_LIBRARY_PATH=/opt/dvi exec /opt/dvi/dvi.bin "$@"\n' >"$base/usr/bin/dvi"
  chmod 755 "$base/usr/bin/dvi"
}

inside() {
  base=$1 dvi=$2
  hostname bare
  mount --make-rprivate /
  mount --rbind /dev "$base/dev"
  mount -t proc proc "$base/proc"
  mount -t sysfs sysfs "$base/sys" 2>/dev/null || true
  mkdir -p "$base/sys/fs/cgroup"
  mount -t tmpfs tmpfs "$base/sys/fs/cgroup"
  mount -t tmpfs tmpfs "$base/run"
  mkdir -p "$base/etc/slurm"
  configure
  install_dvi
  jobs_script >"$base/root/jobs.sh"
  code=0
  timeout 120 chroot "$base" /usr/bin/env -i HOME=/root LANG=C.UTF-8 \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin sh /root/jobs.sh || code=$?
  [ "$code" -eq 0 ] || tail -n 5 "$base"/var/log/slurmctld.log "$base"/var/log/slurmd.log || true
  exit "$code"
}

case ${1:-} in --inside) shift; inside "$@" ;; esac

# ---- outside ----

dvi=${1:?usage: slurm.sh DVI}
[ "$(id -u)" -eq 0 ] || skip 'a bare Debian needs root'
for program in debootstrap unshare chroot ldd; do
  command -v $program >/dev/null || skip "no $program"
done
release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
grep -q '^ID=debian' /etc/os-release || skip 'no Debian, whose libraries the bare Debian shares'
unshare --mount --pid --fork --uts --net true 2>/dev/null || skip 'no namespaces'
home=${DVI_SLURM_HOME:-${TMPDIR:-/tmp}/dvi-slurm-$release}
base=$home/debian
if [ ! -e "$home/done" ]; then
  rm -rf "$base"
  mkdir -p "$base"
  mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null |
    grep -oE 'https?://[^ ]+/debian/?( |$)' | head -n 1 | tr -d ' ')
  # shellcheck disable=SC2086
  debootstrap --variant=minbase --include=slurm-wlm,munge,iproute2 "$release" "$base" $mirror \
    >"$home/log" 2>&1 || { tail -n 3 "$home/log"; skip 'debootstrap failed'; }
  touch "$home/done"
fi
exec unshare --mount --pid --fork --kill-child --uts \
  sh "$here/slurm.sh" --inside "$base" "$dvi"

#!/bin/sh
# The first program of the guest. Its root is the host's file system, read-only; the folder `canlab` of the
# kernel's command line comes out again. It runs `job` there and writes its exit status to `status`.
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t tmpfs tmpfs /run
[ -d /dev/shm ] || mkdir /dev/shm
mount -t tmpfs tmpfs /dev/shm
mkdir /run/out
mount -t hostfs none /run/out -o "$canlab" || echo "the folder $canlab cannot be mounted"
exec >/run/out/guest.txt 2>&1
modules=/usr/lib/uml/modules/$(uname -r)/kernel
for module in net/can/can drivers/net/can/dev/can-dev net/can/can-raw drivers/net/can/vcan; do
  insmod "$modules/$module.ko" || echo "the module $module cannot be loaded"
done
ip link set lo up
sh /run/out/job
echo $? >/run/out/status
echo "uptime [s] $(cat /proc/uptime); jiffies: $(head -1 /proc/stat)"
sync
echo o >/proc/sysrq-trigger
sleep 60

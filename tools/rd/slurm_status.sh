#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# State of a Slurm job for snakemake --cluster-status: running, success or failed. Without it a job
# that Slurm ends (time limit, scancel, lost node) would be waited for forever. Needs no accounting.
state=$(scontrol show job -o "$1" 2>/dev/null | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p')
case $state in
  COMPLETED) echo success ;;
  PENDING | RUNNING | CONFIGURING | COMPLETING | SUSPENDED | REQUEUED) echo running ;;
  *) echo failed ;;
esac

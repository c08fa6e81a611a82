#!/usr/bin/env bash
#SBATCH --job-name=wayfix
#SBATCH --array=1-32
#SBATCH --cpus-per-task=1
#SBATCH --time=02:00:00
#SBATCH --output=campaign/share-%a.log
# One regression as a job array; the folder must be one that all nodes see.
#   mkdir -p campaign && id=$(sbatch --parsable docs/campaigns/slurm.sh)
#   sbatch --dependency=afterok:"$id" --wrap 'wayfix-experiments merge-reports --out campaign campaign/share-*/'
set -euo pipefail
k=$SLURM_ARRAY_TASK_ID n=$SLURM_ARRAY_TASK_COUNT
wayfix-experiments regress slam --seeds 100 --threads 1 --shard "$k/$n" --out "campaign/share-$k"

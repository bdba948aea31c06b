// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// A batch on a farm as a discrete-event simulation: tasks of sessions, slots of nodes, a controller that
// starts so many tasks a second, a store that all share, and nodes that fail. What is not in it: queues of
// other people, and nodes of different speed.

namespace weft::bench {

struct FarmModel {
  int nodes = 1;
  int slots = 1;  ///< tasks of a node at a time
  int tasks = 1;
  int sessions = 1;        ///< of a task
  double session_s = 1;    ///< of one slot, with the store at full speed
  double spread = 0;       ///< standard deviation of that over its mean; log-normal
  double start_s = 0;      ///< of a task's process
  double bytes = 0;        ///< that a session moves from and to the store, while another one is computed
  double store_rate = 0;   ///< bytes a second for all; 0: without limit
  double node_rate = 0;    ///< for one node; 0: without limit
  double starts_rate = 0;  ///< tasks a second; 0: without limit

  double failure_rate = 0;  ///< of a node, a second; 0: none fails
  double notice_s = 0;      ///< until its tasks are queued again
  double wait_s = 0;        ///< that they wait then
  double repair_s = 0;      ///< until the node is back

  std::uint64_t seed = 1;
};

struct FarmOutcome {
  double seconds = 0;         ///< until the last session is done
  std::int64_t sessions = 0;  ///< done, each once
  std::int64_t failures = 0;  ///< of nodes
  std::int64_t requeued = 0;  ///< tasks
  std::int64_t lost = 0;      ///< sessions that were in hand, and were begun again
  double useful_s = 0;        ///< of slots, in sessions that were done
  double lost_s = 0;          ///< of slots, in sessions that were lost
  double busy = 0;            ///< useful_s over what all slots have in `seconds`
};

/// Runs it. A failed node loses the sessions in hand and keeps those done. Sessions share the store alike:
/// each slows down as much as what all ask for is over what there is. The same model gives the same outcome.
FarmOutcome simulate_farm(const FarmModel& model);

}  // namespace weft::bench

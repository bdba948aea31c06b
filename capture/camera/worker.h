// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace weft::capture {

/// The loop of weft-camera: reads a request a line (JSON, at most 64 KiB) from descriptor `in`, answers each
/// with one line on `out`, and ends when `in` does: the parent has closed it or is dead. The camera's session
/// is ended then; if that takes over 3 s the process ends without.
///
///   {"id": 1, "do": "open", "profile": NAME, "port": "", "serial": "", "watch_clock": true}
///       {"id": 1, "ok": {"model", "serial", "port", "battery", "exposure", "clock", "dropped"}}
///       `clock` is {"offset_s", "uncertainty_s"} of the camera's clock, read as UTC, to this machine's, or
///       null; `dropped` counts old photographs that the camera still had and that were thrown away.
///   {"id": 2, "do": "set", "exposure": {"exposure_us", "iso", "f_number"}}
///       {"id": 2, "ok": {"exposure", "battery"}}: as read back
///   {"id": 3, "do": "shutters"}
///       {"id": 3, "ok": {"exposure_us": [...]}}: rising
///   {"id": 4, "do": "take", "file": PATH, "deadline_s": 5.1}
///       {"id": 4, "event": "exposed"}: the shutter must have closed, then within the deadline of the release
///       {"id": 4, "ok": {"file", "sha256", "bytes", "triggered_s", "waited_s"}}: PATH.arrived is whole and
///       synced; `waited_s` is from the release until the camera had it
///   {"id": 5, "do": "bare", "shots": 10}
///       {"id": 5, "ok": {"seconds": [...]}}: of each shot that is thrown away; the yardstick of the
///       benchmark
///   {"id": 6, "do": "look"}
///       {"id": 6, "ok": {"bytes": N}} and after its line N bytes: a JPEG of live view, which set, take and
///       bare end
///   {"id": 7, "do": "stop_looking"}
///       {"id": 7, "ok": {}}: live view is off, and what the camera still had to say is heard
///   {"id": 8, "do": "close"}
///       {"id": 8, "ok": {}}: the session with the camera has ended; it may be opened again
///
/// What fails is answered by {"id", "error": {"kind", "what", "where", "why", "remedy"}}, a line that is no
/// request with "id": null. Every number is in the unit its name ends with; times count from 1970.
void serve_camera(int in, int out);

}  // namespace weft::capture

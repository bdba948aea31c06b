// SPDX-License-Identifier: Apache-2.0
// Comes in by the token behind the address's #, takes it off the address, and shows the rig's state.
const say = (words) => {
  document.getElementById("state").textContent = words;
};

const enter = async () => {
  const token = decodeURIComponent(location.hash.slice(1));
  history.replaceState(null, "", "/");
  if (token !== "") {
    const answer = await fetch("/api/v1/login", {
      method: "POST",
      headers: {"Content-Type": "application/json"},
      body: JSON.stringify({token}),
    });
    if (!answer.ok) throw new Error((await answer.json()).error.what);
  }
  const rig = await fetch("/api/v1/rig");
  if (!rig.ok) throw new Error((await rig.json()).error.remedy);
  const show = (status) => say(JSON.stringify(status, null, 2));
  show(await rig.json());
  new EventSource("/api/v1/events").addEventListener("status", (event) => show(JSON.parse(event.data)));
};

enter().catch((error) => say(error.message));

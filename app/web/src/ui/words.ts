// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them.

/** "0.4 s", "12 s", "3 min 20 s", "2 h 5 min" */
export function durationOf(seconds: number): string {
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor((whole % 3600) / 60)} min`;
}

/** "900 B", "12 kB", "3.4 MB", "1.2 GB" */
export function bytesOf(bytes: number): string {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let unit = 0;
  while (bytes >= 999.5 && unit < units.length - 1) {
    bytes /= 1000;
    unit++;
  }
  return `${bytes < 9.95 && unit > 0 ? bytes.toFixed(1) : bytes.toFixed(0)} ${units[unit]}`;
}

/** A share in percent with as many digits as mean something: "0.02 %", "4.1 %", "37 %". */
export function percentOf(share: number): string {
  const percent = share * 100;
  if (percent === 0) return '0 %';
  return `${percent < 0.1 ? percent.toFixed(3) : percent < 10 ? percent.toFixed(1) : percent.toFixed(0)} %`;
}

/** A time of day, with the date where it is not today's. */
export function timeOf(iso: string): string {
  const time = new Date(iso);
  const isToday = time.toDateString() === new Date().toDateString();
  const clock = time.toLocaleTimeString('en-GB', {hour: '2-digit', minute: '2-digit'});
  return isToday ? clock : `${iso.slice(0, 10)} ${clock}`;
}

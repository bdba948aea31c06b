// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';
import {useLayoutEffect, useRef, useState} from 'preact/hooks';

export interface Viewport {
  top_px: number;
  height_px: number;
}

export interface RowRange {
  first: number;
  end: number;
}

/** However high a window is, a browser is slow with more. */
export const mostRows = 60;

/** Those in view and a few beyond, so that a scroll finds them drawn. */
export function rowsInView(view: Viewport, row_px: number, count: number, beyond = 2): RowRange {
  const seen = Math.ceil(view.height_px / row_px) + 1;
  const drawn = Math.min(seen + 2 * beyond, mostRows, count);
  const wanted = Math.floor(view.top_px / row_px) - beyond;
  const first = Math.max(0, Math.min(wanted, count - drawn));
  return {first, end: first + drawn};
}

interface VirtualListProps {
  label: string;
  /** Tiles in all, drawn or not. */
  count: number;
  /** No tile is narrower. */
  least_px: number;
  /** By how much it is higher than wide. */
  more_px: number;
  keyOf: (index: number) => string | number;
  render: (index: number) => ComponentChildren;
  /** The tiles that are drawn now. */
  onRange?: (range: RowRange) => void;
}

/** A long list of tiles in columns, of which those in view exist. */
export function VirtualList({label, count, least_px, more_px, keyOf, render, onRange}: VirtualListProps) {
  const scroller = useRef<HTMLDivElement>(null);
  const [view, setView] = useState({top_px: 0, height_px: 0, width_px: least_px});
  const look = () => {
    const box = scroller.current;
    if (box) setView({top_px: box.scrollTop, height_px: box.clientHeight, width_px: box.clientWidth});
  };
  useLayoutEffect(() => {
    look();
    const observer = new ResizeObserver(look);
    if (scroller.current) observer.observe(scroller.current);
    return () => observer.disconnect();
  }, []);
  const columns = Math.max(1, Math.floor(view.width_px / least_px));
  const row_px = Math.floor(view.width_px / columns) + more_px;
  const rows = Math.ceil(count / columns);
  const seen = rowsInView(view, row_px, rows);
  const range = {first: seen.first * columns, end: Math.min(seen.end * columns, count)};
  useLayoutEffect(() => onRange?.(range), [range.first, range.end]);
  const indices = Array.from({length: range.end - range.first}, (_, i) => range.first + i);
  return (
    <div class="virtual" ref={scroller} onScroll={look} tabIndex={-1}>
      <ul aria-label={label} style={{height: `${rows * row_px}px`}}>
        {indices.map((index) => (
          <li key={keyOf(index)} aria-setsize={count} aria-posinset={index + 1}
            style={{width: `${100 / columns}%`, height: `${row_px}px`, transform: `translate(${100 * (index % columns)}%, ${Math.floor(index / columns) * row_px}px)`}}>
            {render(index)}
          </li>
        ))}
      </ul>
    </div>
  );
}

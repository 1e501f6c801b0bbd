// SPDX-License-Identifier: Apache-2.0
// A light field in a React page: <LightField src="/can.slf" azimuth={40} onReady={(points) => …} />
import { useEffect, useRef } from 'react';
import 'slf-decoder/viewer/slf_viewer.js';

export function LightField({ onReady, onError, style, ...attributes }) {
  const viewer = useRef(null);
  useEffect(() => {
    const { current } = viewer, end = new AbortController();
    current.addEventListener('ready', ({ detail }) => onReady?.(detail.points), { signal: end.signal });
    current.addEventListener('error', ({ detail }) => onError?.(detail), { signal: end.signal });
    return () => end.abort();
  }, [onReady, onError]);
  return <slf-viewer ref={viewer} style={{ display: 'block', height: 300, ...style }} {...attributes} />;
}

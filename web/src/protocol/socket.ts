// The connection to the program: messages with answers, frames, and the way back after a break. The session's key is kept for the tab, so that a reload takes the session up again.
import type { Failure, Incoming, Outgoing } from './messages';

export type ConnectionState = 'connecting' | 'open' | 'lost' | 'closed';

export type Listener = {
  state(state: ConnectionState): void;
  message(message: Incoming): void;
  frame(data: ArrayBuffer): void;
};

// What a request was refused for.
export class Refused extends Error {
  constructor(readonly failure: Failure) {
    super(failure.problems.map((problem) => [problem.place, problem.reason, problem.hint].filter(Boolean).join(': ')).join('\n') || failure.kind);
  }
}

export class ConnectionLost extends Error {
  constructor() {
    super('the connection was lost');
  }
}

type Waiting = { resolve(message: Incoming): void; reject(error: Error): void; meanwhile?(message: Incoming): void };

const sessionKey = 'crescente.session';
const retryMilliseconds = [250, 500, 1000, 2000, 4000];

export function token(): string {
  return new URLSearchParams(location.search).get('token') ?? '';
}

// An address of the program, with the token.
export function address(path: string, parameters: Record<string, string> = {}): string {
  const url = new URL(path, location.href);
  url.search = new URLSearchParams({ ...Object.fromEntries(url.searchParams), token: token(), ...parameters }).toString();
  return url.href;
}

export class Connection {
  private socket: WebSocket | null = null;
  private waiting = new Map<number, Waiting>();
  private nextId = 1;
  private attempts = 0;
  private ended = false;

  constructor(private readonly listener: Listener) {}

  connect(): void {
    const session = sessionStorage.getItem(sessionKey);
    const url = address('socket', session ? { session } : {}).replace(/^http/, 'ws');
    this.listener.state(this.attempts === 0 ? 'connecting' : 'lost');
    const socket = new WebSocket(url, 'crescente.2');
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.attempts = 0;
      this.listener.state('open');
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      if (typeof event.data === 'string') this.receive(JSON.parse(event.data) as Incoming);
      else this.listener.frame(event.data);
    };
    socket.onclose = () => {
      if (this.socket === socket) this.lost();
    };
    this.socket = socket;
  }

  // Says something that has no answer, or whose answer nobody waits for. What is said while there is no connection is lost: the page tells its state anew when there is one.
  send(message: Outgoing): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  // The answer, or an error: Refused or ConnectionLost. meanwhile: told the progress of what takes long.
  request(message: Outgoing, meanwhile?: (message: Incoming) => void): Promise<Incoming> {
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      if (!this.send({ ...message, id })) reject(new ConnectionLost());
      else this.waiting.set(id, { resolve, reject, meanwhile });
    });
  }

  // Begins with a new session at once.
  restart(): void {
    sessionStorage.removeItem(sessionKey);
    this.ended = false;
    this.attempts = 0;
    const old = this.socket;
    this.socket = null;
    old?.close();
    this.connect();
  }

  private receive(message: Incoming): void {
    if (message.welcome) sessionStorage.setItem(sessionKey, message.welcome.session);
    if (message.closed) {
      this.ended = true;
      sessionStorage.removeItem(sessionKey);
    }
    this.listener.message(message);
    const waiting = message.id === undefined ? undefined : this.waiting.get(message.id);
    if (message.id === undefined || !waiting) return;
    if (message.exporting) {
      waiting.meanwhile?.(message);
      return;
    }
    this.waiting.delete(message.id);
    if (message.error) waiting.reject(new Refused(message.error));
    else waiting.resolve(message);
  }

  private lost(): void {
    this.socket = null;
    for (const waiting of this.waiting.values()) waiting.reject(new ConnectionLost());
    this.waiting.clear();
    if (this.ended) {
      this.listener.state('closed');
      return;
    }
    this.listener.state('lost');
    const delay = retryMilliseconds[Math.min(this.attempts++, retryMilliseconds.length - 1)];
    setTimeout(() => {
      if (!this.socket && !this.ended) this.connect();
    }, delay);
  }
}

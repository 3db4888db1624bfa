//! profirust's DP master drives one station over a pseudo terminal.
//!
//! usage: interop_profirust PTY ADDRESS EXCHANGES
//!
//! The outputs count: exchange n carries n, 16 bits, high octet first, and is repeated unchanged until it has been
//! answered. One line a finished exchange on stdout: `n first-input second-input`. Status 1 when the exchanges are
//! not done after 60 s. What else happens (online, offline ...) goes to stderr, a line each.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use profirust::{dp, fdl, phy::ProfibusPhy, time, Baudrate};

const MASTER: u8 = 2;
const RATE: Baudrate = Baudrate::B500000;
/// 8 ms: a pseudo terminal between two processes of a busy machine is late now and then. Each exchange costs two slots,
/// because this version polls itself as a gap in the ring.
const SLOT_BITS: u16 = 4000;
const TIME_LIMIT: Duration = Duration::from_secs(60);

const O_NOCTTY: i32 = 0o400;
const O_NONBLOCK: i32 = 0o4000;

/// A line without any timing of its own: it is busy for as long as the octets would take on a bus.
struct PtyPhy {
    line: File,
    busy_until: time::Instant,
    tx: [u8; 256],
    rx: Vec<u8>,
}

impl PtyPhy {
    fn open(path: &str) -> std::io::Result<Self> {
        Command::new("stty").args(["-F", path, "raw", "-echo"]).status()?;
        let line = OpenOptions::new().read(true).write(true).custom_flags(O_NOCTTY | O_NONBLOCK).open(path)?;
        Ok(PtyPhy { line, busy_until: time::Instant::ZERO, tx: [0; 256], rx: Vec::new() })
    }
}

impl ProfibusPhy for PtyPhy {
    fn poll_transmission(&mut self, now: time::Instant) -> bool {
        now < self.busy_until
    }

    fn transmit_data<F, R>(&mut self, now: time::Instant, f: F) -> R
    where
        F: FnOnce(&mut [u8]) -> (usize, R),
    {
        let (n, result) = f(&mut self.tx);
        self.line.write_all(&self.tx[..n]).expect("write to the line");
        self.busy_until = now + RATE.bits_to_time(11 * n as u32);
        result
    }

    fn receive_data<F, R>(&mut self, _now: time::Instant, f: F) -> R
    where
        F: FnOnce(&[u8]) -> (usize, R),
    {
        let mut octets = [0; 512];
        if let Ok(n) = self.line.read(&mut octets) {
            self.rx.extend_from_slice(&octets[..n]);
        }
        let (used, result) = f(&self.rx);
        self.rx.drain(..used);
        result
    }
}

fn drive(pty: &str, address: u8, exchanges: u16) -> std::io::Result<bool> {
    // DP-TEST01: an octet in, one out, one in, one out; no user parameters.
    let options = dp::PeripheralOptions {
        ident_number: 0x1234,
        user_parameters: Some(&[]),
        config: Some(&[0x10, 0x20, 0x10, 0x20]),
        max_tsdr: 100,
        ..Default::default()
    };
    let mut inputs = [0; 2];
    let mut outputs = 1u16.to_be_bytes();
    let mut master = dp::DpMaster::new(vec![]);
    let station = master.add(dp::Peripheral::new(address, options, &mut inputs[..], &mut outputs[..]));
    let mut active = fdl::FdlActiveStation::new(
        fdl::ParametersBuilder::new(MASTER, RATE)
            .slot_bits(SLOT_BITS)
            .highest_station_address(MASTER + 1)
            .max_retry_limit(15)
            .watchdog_timeout(time::Duration::from_secs(2))
            .build_verified(&master),
    );
    let mut line = PtyPhy::open(pty)?;
    let start = Instant::now();
    let mut n = 1;

    active.set_online();
    master.enter_operate();
    while n <= exchanges {
        if start.elapsed() > TIME_LIMIT {
            return Ok(false);
        }
        active.poll(time::Instant::from_micros(start.elapsed().as_micros() as i64), &mut line, &mut master);
        match master.take_last_events().peripheral {
            Some((_, dp::PeripheralEvent::DataExchanged)) => {
                let station = master.get_mut(station);
                println!("{n} {:02x} {:02x}", station.pi_i()[0], station.pi_i()[1]);
                n += 1;
                if n <= exchanges {
                    station.pi_q_mut().copy_from_slice(&n.to_be_bytes());
                }
            }
            Some((_, event)) => eprintln!("{event:?}"),
            None => (),
        }
        std::thread::sleep(Duration::from_micros(100));
    }
    Ok(true)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    match drive(&arguments[1], arguments[2].parse().unwrap(), arguments[3].parse().unwrap()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

# Source: EN 50170-2 part 4 (telegrams, FC octet, T_SYN, T_SDR), part 8 (service access points).
import sigrokdecode as srd

SD1, SD2, SD3, SD4, SC, ED = 0x10, 0x68, 0xA2, 0xDC, 0xE5, 0x16
REQUESTS = {3: 'SDA low', 4: 'SDN low', 5: 'SDA high', 6: 'SDN high', 7: 'Request diagnosis', 9: 'FDL Status',
            12: 'SRD low', 13: 'SRD high', 14: 'Ident', 15: 'LSAP Status'}
ANSWERS = {0: 'OK', 1: 'UE', 2: 'RR', 3: 'RS', 8: 'DL', 9: 'NR', 10: 'DH', 12: 'RDL', 13: 'RDH'}
SERVICES = {50: 'DP-V1 Alarm', 51: 'DP-V1 Read/Write', 55: 'Set_Slave_Add', 56: 'RD_Inp', 57: 'RD_Outp',
            58: 'Global_Control', 59: 'Get_Cfg', 60: 'Slave_Diag', 61: 'Set_Prm', 62: 'Chk_Cfg'}
T_SYN = 33  # bit times


class Ann:
    FIELD, DATA, TELEGRAM, TIME, WARNING = range(5)


class Octet:
    def __init__(self, ss, es, value, valid):
        self.ss, self.es, self.value, self.valid = ss, es, value, valid


class Decoder(srd.Decoder):
    api_version = 3
    id = 'profibus_dp'
    name = 'PROFIBUS-DP'
    longname = 'PROFIBUS Decentralized Periphery'
    desc = 'Fieldbus on RS-485, telegrams and DP services.'
    license = 'mit'
    inputs = ['uart']
    outputs = []
    tags = ['Automation']
    options = (
        {'id': 'line', 'desc': 'Line of the UART decoder', 'default': 'rx', 'values': ('rx', 'tx')},
    )
    annotations = (
        ('field', 'Field'),
        ('data', 'Data'),
        ('telegram', 'Telegram'),
        ('time', 'T_SDR'),
        ('warning', 'Warning'),
    )
    annotation_rows = (
        ('fields', 'Fields', (Ann.FIELD, Ann.DATA)),
        ('telegrams', 'Telegrams', (Ann.TELEGRAM,)),
        ('times', 'Times', (Ann.TIME,)),
        ('warnings', 'Warnings', (Ann.WARNING,)),
    )

    def __init__(self):
        self.reset()

    def reset(self):
        self.octets = []
        self.deaf = False  # after a wrong telegram, until T_SYN
        self.bit = None    # samples, from the last octet
        self.asked = None  # (da, sa, service, end) of a request that waits

    def start(self):
        self.out_ann = self.register(srd.OUTPUT_ANN)
        self.line = 0 if self.options['line'] == 'rx' else 1

    def put_ann(self, ss, es, kind, *texts):
        self.put(ss, es, self.out_ann, [kind, list(texts)])

    def warn(self, text):
        self.put_ann(self.octets[0].ss, self.octets[-1].es, Ann.WARNING, text)
        self.octets, self.deaf, self.asked = [], True, None

    def decode(self, ss, es, data):
        kind, line, value = data
        if kind != 'FRAME' or line != self.line:
            return
        if self.octets or self.deaf:
            last = self.octets[-1].es if self.octets else self.silent_since
            if ss - last > T_SYN * self.bit:
                if self.octets:
                    self.warn('Cut short: %d octets' % len(self.octets))
                self.octets, self.deaf = [], False
        self.bit = (es - ss) / 11
        self.silent_since = es
        if self.deaf:
            return
        self.octets.append(Octet(ss, es, value[0], value[1]))
        self.judge()

    # ---- one telegram ------------------------------------------------------------------------------------

    def judge(self):
        o = [x.value for x in self.octets]
        n = len(o)
        if not self.octets[-1].valid:
            self.warn('Parity or framing error in octet %d' % n)
        elif o[0] not in (SD1, SD2, SD3, SD4, SC):
            self.warn('%02X is no start delimiter' % o[0])
        elif o[0] == SD2 and n == 2 and not 4 <= o[1] <= 249:
            self.warn('LE is %d, allowed is 4 to 249' % o[1])
        elif o[0] == SD2 and n == 3 and o[1] != o[2]:
            self.warn('LE %02X is not LEr %02X' % (o[1], o[2]))
        elif o[0] == SD2 and n == 4 and o[3] != SD2:
            self.warn('No second start delimiter')
        elif n == {SD1: 6, SD3: 14, SD4: 3, SC: 1}.get(o[0], o[1] + 6 if n > 1 else 9):
            self.whole(o)

    def whole(self, o):
        start = 4 if o[0] == SD2 else 1
        if o[0] in (SD1, SD2, SD3):
            total = sum(o[start:-2]) & 0xFF
            if o[-2] != total:
                return self.warn('FCS is %02X, right is %02X' % (o[-2], total))
            if o[-1] != ED:
                return self.warn('End delimiter is %02X, not 16' % o[-1])
        if o[0] == SC:
            self.acknowledge()
        elif o[0] == SD4:
            self.fields((('SD4', 1), ('DA %d' % o[1], 1), ('SA %d' % o[2], 1)))
            self.telegram('%d -> %d Token' % (o[2], o[1]))
            self.asked = None
        else:
            self.addressed(o, start)
        self.octets = []

    def fields(self, names):
        """names: (text, octets) of the telegram's parts, in order."""
        at = 0
        for text, n in names:
            if n:
                self.put_ann(self.octets[at].ss, self.octets[at + n - 1].es,
                             Ann.DATA if text.startswith('DU') else Ann.FIELD, text, text.split()[0])
            at += n

    def telegram(self, text):
        self.put_ann(self.octets[0].ss, self.octets[-1].es, Ann.TELEGRAM, text)

    def answered(self):
        _, _, _, end = self.asked
        t_sdr = round((self.octets[0].ss - end) / self.bit)
        self.put_ann(end, self.octets[0].ss, Ann.TIME, 'T_SDR %d T_bit' % t_sdr, '%d' % t_sdr)
        self.asked = None

    def acknowledge(self):
        self.fields((('SC', 1),))
        if not self.asked:
            return self.telegram('Short acknowledge, nobody asked')
        da, sa, service, _ = self.asked
        self.telegram('%d -> %d Short acknowledge of %s' % (da, sa, service))
        self.answered()

    def addressed(self, o, start):
        body, at = o[start:-2], 3
        da, sa, fc = body[0] & 0x7F, body[1] & 0x7F, body[2]
        saps = []
        for i, name in ((0, 'DSAP'), (1, 'SSAP')):
            if body[i] & 0x80:
                if at >= len(body):
                    return self.warn('No room for the SAPs')
                saps.append((name, body[at]))
                at += 1
        head = [('SD2', 1), ('LE %d' % o[1], 1), ('LEr', 1), ('SD2', 1)] if start == 4 else \
               [('SD1' if o[0] == SD1 else 'SD3', 1)]
        names = dict(saps)
        self.fields(head + [('DA %d' % da, 1), ('SA %d' % sa, 1), ('FC %02X' % fc, 1)] +
                    [('%s %d' % s, 1) for s in saps] +
                    [('DU ' + ' '.join('%02X' % x for x in body[at:]), len(body) - at), ('FCS', 1), ('ED', 1)])
        self.speak(da, sa, fc, names)

    def speak(self, da, sa, fc, saps):
        function = fc & 0x0F
        route = '%d%s -> %d%s ' % (sa, '.%d' % saps['SSAP'] if 'SSAP' in saps else '',
                                   da, '.%d' % saps['DSAP'] if 'DSAP' in saps else '')
        if fc & 0x40:
            dp = function in (4, 6, 12, 13)
            service = REQUESTS.get(function, 'unknown') if not dp else \
                SERVICES.get(saps['DSAP'], 'SAP %d' % saps['DSAP']) if 'DSAP' in saps else 'Data_Exchange'
            self.telegram(route + service + ' request')
            wants = function not in (4, 6) and da != 127
            self.asked = (da, sa, service, self.octets[-1].es) if wants else None
            return
        asked = self.asked and self.asked[0] == sa and self.asked[1] == da
        service = self.asked[2] if asked else SERVICES.get(saps.get('SSAP'), 'unknown')
        self.telegram(route + service + ' answer ' + ANSWERS.get(function, 'unknown'))
        if asked:
            self.answered()

-- PROFIBUS-DP for Wireshark and tshark, for what `fieldling-mon -w` writes (link type USER0, sim/mon_pcapng.c).
--
--   tshark -X lua_script:sim/wireshark/profibus_dp.lua -r bus.pcapng
--   Wireshark: put the file into the personal Lua plugins folder (Help, About, Folders)
--
-- Source: EN 50170-2 part 4 (telegrams, FC), part 8 (services).

local dp = Proto("profibus_dp", "PROFIBUS-DP")

-- Wireshark's own bit library: there with each of its Lua versions.
local band, rshift = bit.band, bit.rshift
local function btest(value, mask)
    return band(value, mask) ~= 0
end

local REQUESTS = {[3] = "SDA low", [4] = "SDN low", [5] = "SDA high", [6] = "SDN high", [7] = "Request diagnosis",
                  [9] = "FDL Status", [12] = "SRD low", [13] = "SRD high", [14] = "Ident", [15] = "LSAP Status"}
local ANSWERS = {[0] = "OK", [1] = "UE, user error", [2] = "RR, no resource", [3] = "RS, SAP not activated",
                 [8] = "DL, data", [9] = "NR, no data", [10] = "DH, diagnosis waits", [12] = "RDL", [13] = "RDH"}
local STATIONS = {[0] = "slave", [1] = "master not ready", [2] = "master ready for the ring", [3] = "master in the ring"}
local SERVICES = {[50] = "DP-V1 Alarm", [51] = "DP-V1 Read/Write", [55] = "Set_Slave_Add", [56] = "RD_Inp",
                  [57] = "RD_Outp", [58] = "Global_Control", [59] = "Get_Cfg", [60] = "Slave_Diag", [61] = "Set_Prm",
                  [62] = "Chk_Cfg"}
local DELIMITERS = {[0x10] = "SD1", [0x68] = "SD2", [0xA2] = "SD3", [0xDC] = "SD4 (token)", [0xE5] = "SC (short acknowledge)"}
local LOCKS = {[0] = "only min_T_SDR changes", [1] = "unlock", [2] = "lock", [3] = "unlock"}
local DIRECTIONS = {[1] = "in", [2] = "out", [3] = "in and out"}

-- ---- fields -----------------------------------------------------------------------------------------------------

local f, list = {}, {}
local function add(kind, name, title, ...)
    f[name] = ProtoField[kind]("profibus_dp." .. name, title, ...)
    list[#list + 1] = f[name]
end

add("uint32", "rate", "Bit rate")
add("bool", "wrong", "Wrong on the line", 8, nil, 0x01)
add("uint8", "sd", "Start delimiter", base.HEX, DELIMITERS)
add("uint8", "le", "LE")
add("uint8", "ler", "LEr")
add("uint8", "da", "Destination", base.DEC, nil, 0x7F)
add("uint8", "sa", "Source", base.DEC, nil, 0x7F)
add("uint8", "dsap", "DSAP")
add("uint8", "ssap", "SSAP")
add("uint8", "fc", "FC", base.HEX)
add("bool", "fc.request", "Request", 8, nil, 0x40)
add("bool", "fc.fcb", "FCB", 8, nil, 0x20)
add("bool", "fc.fcv", "FCV", 8, nil, 0x10)
add("uint8", "fc.station", "Station", base.DEC, STATIONS, 0x30)
add("uint8", "fc.request_function", "Function", base.DEC, REQUESTS, 0x0F)
add("uint8", "fc.answer_function", "Function", base.DEC, ANSWERS, 0x0F)
add("string", "service", "Service")
add("bytes", "data", "Data")
add("bytes", "outputs", "Outputs")
add("bytes", "inputs", "Inputs")
add("uint8", "fcs", "FCS", base.HEX)
add("uint8", "ed", "End delimiter", base.HEX)
add("framenum", "response_to", "Request in", base.NONE, frametype.REQUEST)
add("framenum", "response_in", "Answer in", base.NONE, frametype.RESPONSE)
add("double", "t_sdr", "T_SDR [T_bit]")
add("bool", "retry", "Retry")

add("uint8", "prm.status", "Station_status", base.HEX)
add("uint8", "prm.lock", "Lock", base.DEC, LOCKS, 0xC0)
add("bool", "prm.sync", "Sync_Req", 8, nil, 0x20)
add("bool", "prm.freeze", "Freeze_Req", 8, nil, 0x10)
add("bool", "prm.wd_on", "WD_On", 8, nil, 0x08)
add("uint32", "prm.wd_ms", "Watchdog [ms]")
add("uint8", "prm.min_t_sdr", "min_T_SDR [T_bit]")
add("uint16", "prm.ident", "Ident_Number", base.HEX)
add("uint8", "prm.group", "Group_Ident", base.HEX)
add("bytes", "prm.user", "User parameters")

add("uint8", "diag.status1", "Station_status_1", base.HEX)
add("bool", "diag.not_ready", "Station_Not_Ready", 8, nil, 0x02)
add("bool", "diag.cfg_fault", "Cfg_Fault", 8, nil, 0x04)
add("bool", "diag.ext_diag", "Ext_Diag", 8, nil, 0x08)
add("bool", "diag.not_supported", "Not_Supported", 8, nil, 0x10)
add("bool", "diag.prm_fault", "Prm_Fault", 8, nil, 0x40)
add("bool", "diag.master_lock", "Master_Lock", 8, nil, 0x80)
add("uint8", "diag.status2", "Station_status_2", base.HEX)
add("bool", "diag.prm_req", "Prm_Req", 8, nil, 0x01)
add("bool", "diag.stat_diag", "Stat_Diag", 8, nil, 0x02)
add("bool", "diag.wd_on", "WD_On", 8, nil, 0x08)
add("bool", "diag.freeze", "Freeze_Mode", 8, nil, 0x10)
add("bool", "diag.sync", "Sync_Mode", 8, nil, 0x20)
add("bool", "diag.overflow", "Ext_Diag_Overflow", 8, nil, 0x80)
add("uint8", "diag.master", "Master_Add")
add("uint16", "diag.ident", "Ident_Number", base.HEX)
add("bytes", "diag.device", "Device related block")
add("bytes", "diag.identifier", "Identifier related block")
add("bytes", "diag.channel", "Channel related block")

add("bytes", "cfg.identifier", "Identifier")
add("uint16", "cfg.inputs", "Input octets")
add("uint16", "cfg.outputs", "Output octets")

add("uint8", "gc.command", "Control_Command", base.HEX)
add("bool", "gc.clear", "Clear_Data", 8, nil, 0x02)
add("bool", "gc.unfreeze", "Unfreeze", 8, nil, 0x04)
add("bool", "gc.freeze", "Freeze", 8, nil, 0x08)
add("bool", "gc.unsync", "Unsync", 8, nil, 0x10)
add("bool", "gc.sync", "Sync", 8, nil, 0x20)
add("uint8", "gc.group", "Group_Select", base.HEX)

add("uint8", "ssa.new", "New_Slave_Add")
add("uint16", "ssa.ident", "Ident_Number", base.HEX)
add("uint8", "ssa.no_change", "No_Add_Chg")
dp.fields = list

local e = {
    fcs = ProtoExpert.new("profibus_dp.bad_fcs", "FCS is wrong", expert.group.CHECKSUM, expert.severity.ERROR),
    le = ProtoExpert.new("profibus_dp.bad_le", "LE is wrong", expert.group.MALFORMED, expert.severity.ERROR),
    shape = ProtoExpert.new("profibus_dp.bad_telegram", "No telegram", expert.group.MALFORMED, expert.severity.ERROR),
    line = ProtoExpert.new("profibus_dp.bad_octets", "Parity, framing or a gap", expert.group.CHECKSUM, expert.severity.ERROR),
    refused = ProtoExpert.new("profibus_dp.refused", "Refused", expert.group.RESPONSE_CODE, expert.severity.WARN),
    late = ProtoExpert.new("profibus_dp.unasked", "Answer that nobody asked for", expert.group.SEQUENCE, expert.severity.WARN),
}
dp.experts = {e.fcs, e.le, e.shape, e.line, e.refused, e.late}

-- ---- which answer to which request, found in the first pass -----------------------------------------------------

local open, notes, last_to

function dp.init()
    open, notes, last_to = nil, {}, {}
end

-- telegram: {da, sa, request, needs_answer, sc, token, octets, dsap}, start and end in seconds since the first packet
local function pair(pinfo, t, start, finish, bit)
    local note = {}
    notes[pinfo.number] = note
    if t.token then
        open = nil
    elseif t.request then
        note.retry = last_to[t.da] == t.octets and (t.fcv or (open ~= nil and open.da == t.da))
        open = t.needs_answer and {number = pinfo.number, da = t.da, sa = t.sa, dsap = t.dsap, finish = finish,
                                   func = t.func} or nil
        if t.needs_answer then last_to[t.da] = t.octets end
    elseif open and (t.sc or (t.sa == open.da and t.da == open.sa)) then
        note.asked = open
        note.t_sdr = (start - open.finish) / bit
        notes[open.number].answer = pinfo.number
        open = nil
    end
end

-- ---- services ---------------------------------------------------------------------------------------------------

local function service_set_prm(tree, du)
    if du:len() < 7 then return tree:add_proto_expert_info(e.shape, "Set_Prm has 7 octets at least") end
    local status = tree:add(f["prm.status"], du(0, 1))
    for _, name in ipairs({"lock", "sync", "freeze", "wd_on"}) do status:add(f["prm." .. name], du(0, 1)) end
    local base_ms = 10
    if du:len() > 7 and band(du(7, 1):uint(), 0x84) == 0x84 then base_ms = 1 end
    tree:add(f["prm.wd_ms"], du(1, 2), du(1, 1):uint() * du(2, 1):uint() * base_ms)
    tree:add(f["prm.min_t_sdr"], du(3, 1))
    tree:add(f["prm.ident"], du(4, 2))
    tree:add(f["prm.group"], du(6, 1))
    if du:len() > 7 then tree:add(f["prm.user"], du(7)) end
end

local function ext_diag(tree, du, at)
    while at < du:len() do
        local head = du(at, 1):uint()
        local kind, length = rshift(head, 6), band(head, 0x3F)
        if kind == 2 then length = 3 end
        if kind == 3 then length = 2 end
        if length < 2 or at + length > du:len() then
            return tree:add_proto_expert_info(e.shape, "Malformed diagnosis block")
        end
        local name = ({[0] = "diag.device", [1] = "diag.identifier", [2] = "diag.channel"})[kind]
        if name then tree:add(f[name], du(at, length)) end
        at = at + length
    end
end

local function service_slave_diag(tree, du)
    if du:len() < 6 then return tree:add_proto_expert_info(e.shape, "Slave_Diag has 6 octets at least") end
    local one = tree:add(f["diag.status1"], du(0, 1))
    for _, name in ipairs({"not_ready", "cfg_fault", "ext_diag", "not_supported", "prm_fault", "master_lock"}) do
        one:add(f["diag." .. name], du(0, 1))
    end
    local two = tree:add(f["diag.status2"], du(1, 1))
    for _, name in ipairs({"prm_req", "stat_diag", "wd_on", "freeze", "sync"}) do two:add(f["diag." .. name], du(1, 1)) end
    tree:add(f["diag.overflow"], du(2, 1))
    tree:add(f["diag.master"], du(3, 1))
    tree:add(f["diag.ident"], du(4, 2))
    ext_diag(tree, du, 6)
end

local function octets_of(coded, mask)
    local n = band(coded, mask) + 1
    return btest(coded, 0x40) and 2 * n or n
end

local function service_cfg(tree, du)
    local at, total_in, total_out = 0, 0, 0
    while at < du:len() do
        local id, length, text = du(at, 1):uint(), 1, "empty slot"
        if btest(id, 0x30) then
            local n = octets_of(id, 0x0F)
            if btest(id, 0x10) then total_in = total_in + n end
            if btest(id, 0x20) then total_out = total_out + n end
            text = n .. " octets " .. DIRECTIONS[band(rshift(id, 4), 3)]
        else
            local maker = band(id, 0x0F)
            local lengths = rshift(id, 7) + band(rshift(id, 6), 1)
            length = 1 + lengths + (maker == 15 and 0 or maker)
            if at + length > du:len() then return tree:add_proto_expert_info(e.shape, "Identifier is cut short") end
            local next_, parts = at + 1, {}
            if btest(id, 0x80) then
                local n = octets_of(du(next_, 1):uint(), 0x3F)
                total_out, next_ = total_out + n, next_ + 1
                parts[#parts + 1] = n .. " octets out"
            end
            if btest(id, 0x40) then
                local n = octets_of(du(next_, 1):uint(), 0x3F)
                total_in = total_in + n
                parts[#parts + 1] = n .. " octets in"
            end
            if #parts > 0 then text = table.concat(parts, ", ") end
        end
        tree:add(f["cfg.identifier"], du(at, length)):append_text(" (" .. text .. ")")
        at = at + length
    end
    tree:add(f["cfg.inputs"], total_in):set_generated()
    tree:add(f["cfg.outputs"], total_out):set_generated()
end

local function service_global_control(tree, du)
    if du:len() ~= 2 then return tree:add_proto_expert_info(e.shape, "Global_Control has 2 octets") end
    local command = tree:add(f["gc.command"], du(0, 1))
    for _, name in ipairs({"clear", "unfreeze", "freeze", "unsync", "sync"}) do command:add(f["gc." .. name], du(0, 1)) end
    tree:add(f["gc.group"], du(1, 1))
end

local function service_set_slave_add(tree, du)
    if du:len() < 4 then return tree:add_proto_expert_info(e.shape, "Set_Slave_Add has 4 octets at least") end
    tree:add(f["ssa.new"], du(0, 1))
    tree:add(f["ssa.ident"], du(1, 2))
    tree:add(f["ssa.no_change"], du(3, 1))
end

local REQUEST_SERVICES = {[61] = service_set_prm, [62] = service_cfg, [58] = service_global_control, [55] = service_set_slave_add}
local ANSWER_SERVICES = {[60] = service_slave_diag, [59] = service_cfg}

-- ---- one telegram -----------------------------------------------------------------------------------------------

local function sum(tvb, from, to)
    local total = 0
    for i = from, to - 1 do total = total + tvb(i, 1):uint() end
    return total % 256
end

-- Where the body starts and ends, or nil and what is wrong.
local function outline(tvb, tree)
    local sd, n = tvb(0, 1):uint(), tvb:len()
    if sd == 0x10 or sd == 0xA2 then
        local length = sd == 0x10 and 6 or 14
        if n ~= length then return nil, e.shape, n .. " octets, this format has " .. length end
        return 1, n - 2
    end
    if sd ~= 0x68 then return nil, e.shape, string.format("%02X is no start delimiter", sd) end
    if n < 4 then return nil, e.shape, "Cut short" end
    local le, ler = tvb(1, 1):uint(), tvb(2, 1):uint()
    tree:add(f.le, tvb(1, 1))
    tree:add(f.ler, tvb(2, 1))
    if le ~= ler then return nil, e.le, string.format("LE %02X is not LEr %02X", le, ler) end
    if le < 4 or le > 249 then return nil, e.le, "LE is " .. le .. ", allowed is 4 to 249" end
    if tvb(3, 1):uint() ~= 0x68 then return nil, e.shape, "No second start delimiter" end
    if n ~= le + 6 then return nil, e.shape, n .. " octets, LE announces " .. le + 6 end
    return 4, n - 2
end

local function control(tvb, tree, at, t)
    local fc = tvb(at, 1):uint()
    local item = tree:add(f.fc, tvb(at, 1))
    t.request, t.func = btest(fc, 0x40), band(fc, 0x0F)
    item:add(f["fc.request"], tvb(at, 1))
    if t.request then
        t.fcv = btest(fc, 0x10)
        item:add(f["fc.fcb"], tvb(at, 1))
        item:add(f["fc.fcv"], tvb(at, 1))
        item:add(f["fc.request_function"], tvb(at, 1))
    else
        item:add(f["fc.station"], tvb(at, 1))
        item:add(f["fc.answer_function"], tvb(at, 1))
    end
    t.needs_answer = t.request and t.func ~= 4 and t.func ~= 6 and t.da ~= 127
end

-- -> what the telegram is, with t.du_at, t.du_to; nil when it is none
local function body(tvb, tree)
    local from, to, text = outline(tvb, tree)
    if not from then
        tree:add_proto_expert_info(to, text)
        return nil, text
    end
    local t = {da = band(tvb(from, 1):uint(), 0x7F), sa = band(tvb(from + 1, 1):uint(), 0x7F)}
    tree:add(f.da, tvb(from, 1))
    tree:add(f.sa, tvb(from + 1, 1))
    control(tvb, tree, from + 2, t)
    local at = from + 3
    for _, side in ipairs({"d", "s"}) do
        if btest(tvb(from + (side == "d" and 0 or 1), 1):uint(), 0x80) then
            if at >= to then
                tree:add_proto_expert_info(e.shape, "No room for the SAPs")
                return nil, "no room for the SAPs"
            end
            t[side .. "sap"] = tvb(at, 1):uint()
            tree:add(f[side .. "sap"], tvb(at, 1))
            at = at + 1
        end
    end
    t.du_at, t.du_to = at, to
    local right = sum(tvb, from, to)
    local fcs = tree:add(f.fcs, tvb(to, 1))
    if tvb(to, 1):uint() ~= right then
        text = string.format("FCS is %02X, right is %02X", tvb(to, 1):uint(), right)
        fcs:add_proto_expert_info(e.fcs, text)
        return nil, text
    end
    local ed = tree:add(f.ed, tvb(to + 1, 1))
    if tvb(to + 1, 1):uint() ~= 0x16 then
        ed:add_proto_expert_info(e.shape, "End delimiter is not 16")
        return nil, "end delimiter is not 16"
    end
    return t
end

local function is_dp(func)
    return func == 4 or func == 6 or func == 12 or func == 13
end

-- The service of a request, or of an answer to `asked`.
local function service_name(t, asked)
    local sap
    if t.request then
        if not is_dp(t.func) then return REQUESTS[t.func] or "unknown" end
        sap = t.dsap
    else
        if asked and not is_dp(asked.func) then return REQUESTS[asked.func] or "unknown" end
        if not asked and not t.ssap then return "unknown" end
        sap = t.ssap or (asked and asked.dsap)
    end
    if sap == nil then return "Data_Exchange" end
    return SERVICES[sap] or ("SAP " .. sap)
end

local function content(tvb, tree, t, name)
    local handler = (t.request and REQUEST_SERVICES or ANSWER_SERVICES)[t.request and t.dsap or t.ssap]
    if t.du_to == t.du_at then return end
    local du = tvb(t.du_at, t.du_to - t.du_at):tvb()
    if handler then
        handler(tree:add(dp, du(), name), du)
    elseif name == "Data_Exchange" then
        tree:add(t.request and f.outputs or f.inputs, du())
    else
        tree:add(f.data, du())
    end
end

local function notes_of(tree, note)
    if note.asked then tree:add(f.response_to, note.asked.number):set_generated() end
    if note.answer then tree:add(f.response_in, note.answer):set_generated() end
    if note.t_sdr then tree:add(f.t_sdr, note.t_sdr):set_generated() end
    if note.retry then tree:add(f.retry, true):set_generated() end
end

local function with_sap(station, sap)
    return sap and station .. "." .. sap or tostring(station)
end

-- tvb: the telegram alone. -> info column, source, destination
local function telegram(tvb, pinfo, tree, bit)
    local sd = tvb(0, 1):uint()
    tree:add(f.sd, tvb(0, 1))
    local start = pinfo.rel_ts
    local finish = start + tvb:len() * 11 * bit
    local t
    if sd == 0xE5 and tvb:len() == 1 then
        t = {sc = true}
    elseif sd == 0xDC and tvb:len() == 3 then
        tree:add(f.da, tvb(1, 1))
        tree:add(f.sa, tvb(2, 1))
        t = {token = true, da = tvb(1, 1):uint(), sa = tvb(2, 1):uint()}
    else
        local wrong
        t, wrong = body(tvb, tree)
        if not t then return "wrong: " .. wrong end
    end
    t.octets = tostring(tvb:bytes())
    if not pinfo.visited then pair(pinfo, t, start, finish, bit) end
    local note = notes[pinfo.number] or {}
    notes_of(tree, note)
    if t.token then return "Token", t.sa, t.da end
    if not t.request and not note.asked then tree:add_proto_expert_info(e.late) end
    local name = t.sc and (note.asked and service_name({request = true, func = note.asked.func, dsap = note.asked.dsap})
                           or "unknown") or service_name(t, note.asked)
    tree:add(f.service, name):set_generated()
    if t.sc then
        return "Short acknowledge of " .. name, note.asked and note.asked.da, note.asked and note.asked.sa
    end
    content(tvb, tree, t, name)
    local info = name .. (t.request and " request" or " answer")
    if not t.request and t.func ~= 8 and t.func ~= 0 then
        info = info .. ", " .. (ANSWERS[t.func] or "unknown function")
        if t.func <= 3 then tree:add_proto_expert_info(e.refused, ANSWERS[t.func]) end
    end
    if note.retry then info = info .. " (retry)" end
    return info, with_sap(t.sa, t.ssap), with_sap(t.da, t.dsap)
end

function dp.dissector(tvb, pinfo, tree)
    if tvb:len() < 9 or tvb(0, 1):uint() ~= 1 or tvb(1, 1):uint() ~= 0 then return 0 end
    local item = tree:add(dp, tvb(8))
    local rate = tvb(4, 4):uint()
    pinfo.cols.protocol = "PROFIBUS-DP"
    item:add(f.rate, tvb(4, 4)):set_text("Bit rate: " .. rate .. " bit/s")
    item:add(f.wrong, tvb(2, 1))
    local info, source, destination = telegram(tvb(8):tvb(), pinfo, item, 1 / rate)
    if tvb(2, 1):uint() ~= 0 and not info:find("^wrong") then
        item:add_proto_expert_info(e.line)
        info = "wrong octets: " .. info
    end
    pinfo.cols.info = info
    if source then pinfo.cols.src = tostring(source) end
    if destination then pinfo.cols.dst = destination == 127 and "all" or tostring(destination) end
    item:append_text(", " .. info)
    return tvb:len()
end

DissectorTable.get("wtap_encap"):add(wtap.USER0, dp)
